#pragma once
#include <cstdint>
#include <memory>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace talus::io {

/// New rows of a table of SQLite, by one prepared statement. Values are set in the order of the columns, then the row
/// is inserted. All throw std::runtime_error with SQLite's message.
class SqliteRows {
 public:
  /// @param database  must outlive this object
  /// @param into      "INSERT INTO "stops" ("geom", "source")"
  /// @param columns   how many values a row has
  SqliteRows(sqlite3* database, const std::string& into, int columns);

  void add(std::int64_t value);
  void add(double value);
  void add(const char* text);  ///< must stay until the row is inserted, as the bytes of `add_bytes`
  void add_bytes(const void* bytes, std::size_t size);
  void add_null();
  void insert();

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  void check(int code, int expected) const;

  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int next_ = 1;  // value of the row, from 1
};

}  // namespace talus::io
