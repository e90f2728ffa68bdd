// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "run/trajectory_db.h"

// In place of trajectory_db.cpp where there is no SQLite.
namespace throng::app {

bool has_sqlite() { return false; }

Result<void> export_sqlite(Replay&, const std::string&, const std::string& path,
                           const ExportConfig&, Context&) {
  return Error{Errc::kBadConfig, path +
                                     ": this program was built without SQLite; install "
                                     "libsqlite3-dev and build it again, or use --csv or --txt"};
}

}  // namespace throng::app
