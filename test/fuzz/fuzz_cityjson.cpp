// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "fuzz_reader.h"
#include "import/formats/city.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  return throng::fuzz_reader(throng::importer::read_cityjson, bytes, size);
}
