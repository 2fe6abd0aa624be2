// Checkpoints: everything that decides the next step, in full precision, in one HDF5 file.
//
// A checkpoint is a set of named one-dimensional arrays, numbers and texts; names may contain '/'. Beside
// them it holds the version of this layout, the version of the program, and the resolved case with its hash.
// Every array carries a checksum and HDF5's metadata theirs, and opening a checkpoint reads and checks all of
// it: a damaged or truncated file is refused before anything of it is used. A new checkpoint replaces the old
// one by renaming once it is complete on disk, so the last good one is never lost.
//
// Failures are EnvironmentErrors that name file and array; a checkpoint of another case is an InputError.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace polder {

// Layout of the file, raised when old checkpoints can no longer be read.
inline constexpr std::int64_t kCheckpointFormat = 1;

namespace detail {
template <class T>
inline constexpr bool kCheckpointType =
    std::is_same_v<T, double> || std::is_same_v<T, std::int32_t> || std::is_same_v<T, std::int64_t> ||
    std::is_same_v<T, std::uint64_t> || std::is_same_v<T, char>;
}

class CheckpointWriter {
 public:
  // resolved_case: the case with all defaults; its text is stored so that a restart can say what differs.
  CheckpointWriter(std::filesystem::path path, std::string_view program_version,
                   std::string_view resolved_case);
  ~CheckpointWriter();
  CheckpointWriter(const CheckpointWriter&) = delete;
  CheckpointWriter& operator=(const CheckpointWriter&) = delete;

  // The values are copied at once. A name may be used only once (std::invalid_argument).
  void put(const std::string& name, std::span<const double> values);
  void put(const std::string& name, std::span<const std::int32_t> values);
  void put(const std::string& name, std::span<const std::int64_t> values);
  void put(const std::string& name, std::span<const std::uint64_t> values);
  void put(const std::string& name, std::span<const char> values);
  void put_text(const std::string& name, std::string_view text);
  template <class T>
  requires detail::kCheckpointType<T>
  void put_number(const std::string& name, T value) { put(name, std::span<const T>(&value, 1)); }

  // To disk, once. Until this returns, the previous checkpoint of that name stands. It may be called by
  // another thread than the one that put the values in: nothing before it touches HDF5 or the disk.
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

class CheckpointReader {
 public:
  // Opens and checks the whole file.
  explicit CheckpointReader(std::filesystem::path path);
  ~CheckpointReader();
  CheckpointReader(const CheckpointReader&) = delete;
  CheckpointReader& operator=(const CheckpointReader&) = delete;

  const std::string& program_version() const;
  const std::string& resolved_case() const;
  std::uint64_t case_hash() const;
  // InputError with the first line that differs if the checkpoint was written for another case.
  void require_case(std::string_view resolved_case) const;

  bool has(const std::string& name) const;
  std::vector<std::string> names() const;

  // The array `name`, which must hold values of type T.
  template <class T>
  requires detail::kCheckpointType<T> std::vector<T> array(const std::string& name)
  const;
  // The same into memory of the caller, whose size it must have.
  template <class T>
  requires detail::kCheckpointType<T>
  void read(const std::string& name, std::span<T> values) const;
  template <class T>
  requires detail::kCheckpointType<T> T number(const std::string& name)
  const;
  std::string text(const std::string& name) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace polder
