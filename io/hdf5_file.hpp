// The few HDF5 calls that frames and checkpoints are made of (C API), for the sources of io/ only.
//
// Files are built in memory (HDF5's core driver) and then written in one go by write_file_atomically. So a
// full disk meets plain write() with its errno, and never a half-open HDF5 file, from which the library
// cannot recover. The library's own error printing is off; every failure is an EnvironmentError that names
// file and object.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace polder::hdf5 {

// Owns one HDF5 identifier of any kind.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  ~Handle() { reset(); }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  operator hid_t() const { return id_; }
  bool valid() const { return id_ >= 0; }
  void reset() {
    if (id_ >= 0) close_(id_);
    id_ = -1;
  }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

// The HDF5 type of a C++ number in memory and, little-endian, in files.
template <class T>
hid_t memory_type();
template <class T>
hid_t file_type();

// A file under construction in memory. Object names may contain '/': the groups are created as needed. No
// times are stored, so that the same content makes the same bytes.
class Image {
 public:
  // expected_bytes: roughly how large it will be; memory is taken in pieces of that size.
  Image(std::filesystem::path path, std::size_t expected_bytes);

  void group(const std::string& name);
  // rows x columns numbers (columns = 0: one-dimensional), stored as stored_type.
  template <class T>
  void dataset(const std::string& name, std::span<const T> values, hsize_t columns, hid_t stored_type);
  template <class T>
  void dataset(const std::string& name, std::span<const T> values) {
    dataset(name, values, 0, file_type<T>());
  }
  // Attribute of an existing object; "/" is the file itself.
  template <class T>
  void attribute(const std::string& object, const std::string& name, std::span<const T> values);
  void attribute(const std::string& object, const std::string& name, const std::string& fixed_length_text);

  // To disk under the path of the constructor; the image cannot be used afterwards.
  void write();

 private:
  void groups_above(const std::string& name);  // made where they are missing

  std::filesystem::path path_;
  std::set<std::string> groups_;
  Handle file_;
  Handle group_creation_, dataset_creation_;
};

// A file read from disk.
class Reader {
 public:
  explicit Reader(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  bool has(const std::string& name) const;
  std::vector<std::string> datasets() const;  // full names of all, without the leading '/', in order of name
  // Empty if the object has no such attribute.
  std::string text_attribute(const std::string& object, const std::string& name) const;
  template <class T>
  std::vector<T> attribute(const std::string& object, const std::string& name) const;
  // The dataset as one flat array. It must hold values of exactly type T if `exact`, any number otherwise.
  template <class T>
  std::vector<T> dataset(const std::string& name, bool exact = false) const;
  // The bytes as stored, whatever their type.
  std::vector<std::byte> raw(const std::string& name) const;

 private:
  [[noreturn]] void fail(const std::string& object, const std::string& problem) const;
  std::filesystem::path path_;
  Handle file_;
};

}  // namespace polder::hdf5
