# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
# find_package(throng) for other projects: library, headers, version and the dependencies of a static build.
include(CMakePackageConfigHelpers)

set(THRONG_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/throng)
install(TARGETS throng EXPORT throngTargets FILE_SET HEADERS)
install(EXPORT throngTargets NAMESPACE throng:: DESTINATION ${THRONG_CONFIG_DIR})
if(NOT DEFINED BUILD_SHARED_LIBS)
  set(BUILD_SHARED_LIBS OFF)
endif()
configure_package_config_file(cmake/throngConfig.cmake.in
                              ${CMAKE_CURRENT_BINARY_DIR}/throngConfig.cmake
                              INSTALL_DESTINATION ${THRONG_CONFIG_DIR})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/throngConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/throngConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/throngConfigVersion.cmake
        DESTINATION ${THRONG_CONFIG_DIR})
