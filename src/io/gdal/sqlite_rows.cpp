#include "sqlite_rows.hpp"

#include <sqlite3.h>

#include <stdexcept>

namespace talus::io {

void SqliteRows::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

SqliteRows::SqliteRows(sqlite3* database, const std::string& into, int columns) : database_(database) {
  std::string sql = into + " VALUES (?";
  for (int i = 1; i < columns; ++i) sql += ",?";
  sql += ')';
  sqlite3_stmt* statement = nullptr;
  check(sqlite3_prepare_v2(database_, sql.c_str(), -1, &statement, nullptr), SQLITE_OK);
  statement_.reset(statement);
}

void SqliteRows::add(std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), next_++, value), SQLITE_OK);
}

void SqliteRows::add(double value) {
  check(sqlite3_bind_double(statement_.get(), next_++, value), SQLITE_OK);
}

void SqliteRows::add(const char* text) {
  check(sqlite3_bind_text(statement_.get(), next_++, text, -1, SQLITE_STATIC), SQLITE_OK);
}

void SqliteRows::add_bytes(const void* bytes, std::size_t size) {
  check(sqlite3_bind_blob64(statement_.get(), next_++, bytes, size, SQLITE_STATIC), SQLITE_OK);
}

void SqliteRows::add_null() {
  check(sqlite3_bind_null(statement_.get(), next_++), SQLITE_OK);
}

void SqliteRows::insert() {
  check(sqlite3_step(statement_.get()), SQLITE_DONE);
  check(sqlite3_reset(statement_.get()), SQLITE_OK);
  next_ = 1;
}

void SqliteRows::check(int code, int expected) const {
  if (code != expected) throw std::runtime_error(sqlite3_errmsg(database_));
}

}  // namespace talus::io
