#pragma once
#include <cstddef>
#include <optional>
#include <string>

namespace talus::io {

/// Largest files that are read whole [byte]. docs/security.md has the list.
inline constexpr std::size_t kMostToml = std::size_t{4} << 20U, kMostVrt = std::size_t{32} << 20U,
                             kMostRecord = std::size_t{256} << 20U, kMostTable = std::size_t{2} << 30U;

/// What a name stands for that is there and no regular file, "is a pipe, must be a regular file ..."; nothing for a
/// regular file, a link to one, and a name of nothing. Opens nothing: a pipe or a device would be waited for.
std::optional<std::string> fault_of_file(const std::string& path);

/// The bytes of a regular file. `name` stands for it in messages, `what` for what it must be ("a TOML file").
/// Throws InputError if it cannot be read, is no regular file or has more than `most` bytes.
std::string read_file(const std::string& path, const std::string& name, const std::string& what, std::size_t most);

/// The bytes of one of GDAL's files (/vsizip/a.zip/dem.vrt); at most `most`, and one more if there are more. Empty if
/// there is none.
std::string read_start(const std::string& name, std::size_t most);

}  // namespace talus::io
