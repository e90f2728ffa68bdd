# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
# The build for browsers uses these instead of the machine's libraries: headers only, each linked
# into a folder of its own, because /usr/include as a whole belongs to another system. Dear ImGui has to be
# compiled; scripts/web fetches its source.
set(WEB_HEADERS ${CMAKE_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${WEB_HEADERS})
foreach(header fmt hwy xxhash.h flatbuffers stb toml++ nlohmann CLI)
  if(NOT EXISTS /usr/include/${header})
    message(FATAL_ERROR "/usr/include/${header} is not there; scripts/install_deps installs it")
  endif()
  file(CREATE_LINK /usr/include/${header} ${WEB_HEADERS}/${header} SYMBOLIC)
endforeach()
set(FLATBUFFERS_INCLUDE ${WEB_HEADERS})
set(STB_INCLUDE ${WEB_HEADERS})
set(TOMLPP_INCLUDE ${WEB_HEADERS})
set(NLOHMANN_INCLUDE ${WEB_HEADERS})
find_program(FLATC flatc REQUIRED)

foreach(name TBB::tbb PkgConfig::HWY PkgConfig::XXHASH PkgConfig::PUGIXML PkgConfig::SIMDJSON
        assimp::assimp PkgConfig::EPOXY)
  add_library(${name} INTERFACE IMPORTED)
endforeach()
target_include_directories(PkgConfig::HWY SYSTEM INTERFACE ${WEB_HEADERS})
add_library(fmt::fmt INTERFACE IMPORTED)
target_include_directories(fmt::fmt SYSTEM INTERFACE ${WEB_HEADERS})
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)

set(THRONG_IMGUI_SOURCE "" CACHE PATH "Folder of Dear ImGui's source (scripts/web sets it)")
if(NOT EXISTS ${THRONG_IMGUI_SOURCE}/imgui.cpp)
  message(FATAL_ERROR "THRONG_IMGUI_SOURCE holds no imgui.cpp; build with scripts/web")
endif()
add_library(web_imgui STATIC ${THRONG_IMGUI_SOURCE}/imgui.cpp ${THRONG_IMGUI_SOURCE}/imgui_draw.cpp
            ${THRONG_IMGUI_SOURCE}/imgui_tables.cpp ${THRONG_IMGUI_SOURCE}/imgui_widgets.cpp)
target_include_directories(web_imgui SYSTEM PUBLIC ${THRONG_IMGUI_SOURCE})
set_target_properties(web_imgui PROPERTIES COMPILE_WARNING_AS_ERROR OFF)
add_library(PkgConfig::IMGUI ALIAS web_imgui)
# The one file that hashes also compiles the hash.
set_source_files_properties(${PROJECT_SOURCE_DIR}/src/core/hash.cpp PROPERTIES COMPILE_DEFINITIONS XXH_INLINE_ALL)
# Exceptions are disabled, except in parsers, which throw the faults of a file.
set_source_files_properties(${PROJECT_SOURCE_DIR}/src/core/files/config_file.cpp PROPERTIES COMPILE_OPTIONS -fexceptions)
