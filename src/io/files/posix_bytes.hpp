#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "talus/base/open_file.hpp"

namespace talus::io {

/// Text of an error number (`errno`); of that of a full disk "the disk is full".
std::string system_text(int cause);

/// Creates a file for writing and reading, or empties it. Throws std::runtime_error
OpenFile create_file(const std::filesystem::path& path);

/// Writes all bytes at a place of a file. Throws std::runtime_error
void write_bytes(const OpenFile& file, std::span<const std::byte> bytes, std::uint64_t offset);

/// Reads as many bytes as there is room for, from a place of a file. Throws std::runtime_error
void read_bytes(const OpenFile& file, std::span<std::byte> bytes, std::uint64_t offset);

}  // namespace talus::io
