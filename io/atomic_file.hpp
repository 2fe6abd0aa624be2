// Result files that are either complete or absent.
//
// A file is written under a temporary name beside its final one, forced to disk and renamed; a run that is
// killed, or a disk that fills up, leaves the previous version untouched. Every failure is an
// EnvironmentError that names the file and carries the text of errno.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace polder {

// Files that end in this were left by a run that was killed while writing; they may be deleted.
inline constexpr std::string_view kTemporarySuffix = ".tmp";

// Throws EnvironmentError "path: problem: text of errno".
[[noreturn]] void throw_file_error(const std::filesystem::path& path, const std::string& problem,
                                   int error_number);

// All bytes to an open descriptor, continuing after partial writes and signals. Returns 0 or errno.
int write_fully(int descriptor, const void* data, std::size_t bytes);

void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> content);
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

// Whole content of a file; EnvironmentError if it cannot be read.
std::string read_file(const std::filesystem::path& path);

}  // namespace polder
