// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "run/trajectory_db.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "throng/avatar.h"

// Writes a recording as an SQLite file in the tables of JuPedSim, in one transaction.
namespace throng::app {
namespace {

// An SQLite file that is NAME.part until it is whole. Remembers the first failure.
class Database {
 public:
  explicit Database(const std::string& path) : path_(path), part_(path + ".part") {
    std::remove(part_.c_str());
    keep(sqlite3_open(part_.c_str(), &db_));
  }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;
  ~Database() {
    for (sqlite3_stmt* statement : statements_) sqlite3_finalize(statement);
    sqlite3_close(db_);
    std::remove(part_.c_str());
  }

  void run(const char* sql) {
    if (code_ == SQLITE_OK) keep(sqlite3_exec(db_, sql, nullptr, nullptr, nullptr));
  }
  sqlite3_stmt* prepare(const char* sql) {
    sqlite3_stmt* statement = nullptr;
    if (code_ == SQLITE_OK) keep(sqlite3_prepare_v2(db_, sql, -1, &statement, nullptr));
    statements_.push_back(statement);
    return statement;
  }
  void step(sqlite3_stmt* statement) {
    if (code_ != SQLITE_OK) return;
    const int code = sqlite3_step(statement);
    if (code != SQLITE_DONE) keep(code);
    sqlite3_reset(statement);
  }

  [[nodiscard]] bool failed() const { return code_ != SQLITE_OK; }

  Result<void> close() {
    for (sqlite3_stmt* statement : statements_) sqlite3_finalize(statement);
    statements_.clear();
    if (code_ == SQLITE_OK) keep(sqlite3_close(db_));
    db_ = code_ == SQLITE_OK ? nullptr : db_;
    if (code_ == SQLITE_OK && std::rename(part_.c_str(), path_.c_str()) != 0) code_ = SQLITE_IOERR;
    if (code_ == SQLITE_OK) return {};
    return Error{Errc::kIo, fmt::format("{}: cannot write: {}; check the folder, its rights and "
                                        "the free space",
                                        path_, sqlite3_errstr(code_))};
  }

 private:
  void keep(int code) {
    if (code_ == SQLITE_OK) code_ = code;
  }

  std::string path_, part_;
  sqlite3* db_ = nullptr;
  std::vector<sqlite3_stmt*> statements_;
  int code_ = SQLITE_OK;
};

// The key that joins frames to the only geometry: a hash of its text.
int64_t geometry_hash(const std::string& wkt) {
  uint64_t hash = 1469598103934665603ULL;  // FNV-1a
  for (const char c : wkt) hash = (hash ^ static_cast<uint8_t>(c)) * 1099511628211ULL;
  return static_cast<int64_t>(hash >> 1);
}

}  // namespace

bool has_sqlite() { return true; }

Result<void> export_sqlite(Replay& replay, const std::string& wkt, const std::string& path,
                           const ExportConfig& config, Context& context) {
  const Result<FilmRate> film = film_rate(replay);
  if (!film) return film.error();
  Database db(path);
  db.run(
      "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; BEGIN;"
      "CREATE TABLE trajectory_data(frame INTEGER NOT NULL, id INTEGER NOT NULL,"
      " pos_x REAL NOT NULL, pos_y REAL NOT NULL, ori_x REAL NOT NULL, ori_y REAL NOT NULL);"
      "CREATE TABLE metadata(key TEXT NOT NULL UNIQUE PRIMARY KEY, value TEXT NOT NULL);"
      "CREATE TABLE geometry(hash INTEGER NOT NULL, wkt TEXT NOT NULL);"
      "CREATE UNIQUE INDEX geometry_hash ON geometry(hash);"
      "CREATE TABLE frame_data(frame INTEGER NOT NULL, geometry_hash INTEGER NOT NULL);");
  sqlite3_stmt* row = db.prepare("INSERT INTO trajectory_data VALUES(?, ?, ?, ?, ?, ?)");
  sqlite3_stmt* about = db.prepare("INSERT INTO metadata VALUES(?, ?)");
  sqlite3_stmt* area = db.prepare("INSERT INTO geometry VALUES(?, ?)");
  sqlite3_stmt* joined = db.prepare("INSERT INTO frame_data VALUES(?, ?)");

  const int64_t hash = geometry_hash(wkt);
  if (!wkt.empty() && !db.failed()) {
    sqlite3_bind_int64(area, 1, hash);
    sqlite3_bind_text(area, 2, wkt.c_str(), -1, SQLITE_TRANSIENT);
    db.step(area);
  }
  Box3d box;
  RecordedFrame frame;
  for (uint64_t f = 0; f < replay.frame_count() && !db.failed(); ++f) {
    if (context.on_progress) context.on_progress({"export", f, replay.frame_count()});
    if (context.cancel) return Error{Errc::kCancelled, path + ": cancelled"};
    if (auto ok = replay.read(f, frame); !ok) return ok;
    const auto number = static_cast<int64_t>(film->frame_of(frame.step));
    for (size_t i = 0; i < frame.size(); ++i) {
      const Vec3d& p = frame.positions[i];
      if (p.y < config.lowest || p.y > config.highest) continue;
      box.add(p);
      sqlite3_bind_int64(row, 1, number);
      sqlite3_bind_int64(row, 2, static_cast<int64_t>(frame.ids[i]));
      sqlite3_bind_double(row, 3, p.x);
      sqlite3_bind_double(row, 4, p.z);
      Vec3d ahead{frame.headings[i].x, 0, frame.headings[i].z};
      if (!frame.up_vectors.empty()) ahead = leaned(ahead, frame.up_vectors[i]);
      sqlite3_bind_double(row, 5, ahead.x);
      sqlite3_bind_double(row, 6, ahead.z);
      db.step(row);
    }
    sqlite3_bind_int64(joined, 1, number);
    sqlite3_bind_int64(joined, 2, hash);
    if (!wkt.empty()) db.step(joined);
  }
  const auto add_metadata = [&](const char* key, const std::string& value) {
    if (db.failed()) return;
    sqlite3_bind_text(about, 1, key, -1, SQLITE_TRANSIENT);
    sqlite3_bind_text(about, 2, value.c_str(), -1, SQLITE_TRANSIENT);
    db.step(about);
  };
  add_metadata("version", "2");
  add_metadata("fps", fmt::format("{}", film->rate));
  if (!box.empty()) {
    add_metadata("xmin", fmt::format("{}", box.min.x));
    add_metadata("xmax", fmt::format("{}", box.max.x));
    add_metadata("ymin", fmt::format("{}", box.min.z));
    add_metadata("ymax", fmt::format("{}", box.max.z));
  }
  db.run("CREATE INDEX frame_id_idx ON trajectory_data(frame, id); COMMIT;");
  return db.close();
}

}  // namespace throng::app
