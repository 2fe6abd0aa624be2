#include "io/hdf5_file.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>

#include "core/error.hpp"
#include "io/atomic_file.hpp"

namespace polder::hdf5 {
namespace fs = std::filesystem;
namespace {

// HDF5 prints its whole error stack to stderr unless told otherwise.
void silence() {
  static const bool done = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  (void)done;
}

herr_t keep_innermost(unsigned depth, const H5E_error2_t* error, void* text) {
  if (depth == 0 && error->desc) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

// What the library says went wrong, in its own words: the innermost entry of its error stack.
std::string library_reason() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, &text);
  return text.empty() ? "HDF5 gives no reason" : text;
}

[[noreturn]] void fail_at(const fs::path& path, const std::string& object, const std::string& problem) {
  throw EnvironmentError(path.string() + ": " + object + ": " + problem);
}

void require(bool good, const fs::path& path, const std::string& object) {
  if (!good) fail_at(path, object, "HDF5: " + library_reason());
}

Handle checked(hid_t id, Handle::Close close, const fs::path& path, const std::string& object) {
  require(id >= 0, path, object);
  return Handle(id, close);
}

}  // namespace

#define POLDER_HDF5_TYPE(T, MEMORY, FILE) \
  template <>                             \
  hid_t memory_type<T>() {                \
    return MEMORY;                        \
  }                                       \
  template <>                             \
  hid_t file_type<T>() {                  \
    return FILE;                          \
  }
POLDER_HDF5_TYPE(double, H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE)
POLDER_HDF5_TYPE(float, H5T_NATIVE_FLOAT, H5T_IEEE_F32LE)
POLDER_HDF5_TYPE(std::int32_t, H5T_NATIVE_INT32, H5T_STD_I32LE)
POLDER_HDF5_TYPE(std::int64_t, H5T_NATIVE_INT64, H5T_STD_I64LE)
POLDER_HDF5_TYPE(std::uint64_t, H5T_NATIVE_UINT64, H5T_STD_U64LE)
POLDER_HDF5_TYPE(std::uint8_t, H5T_NATIVE_UINT8, H5T_STD_U8LE)
POLDER_HDF5_TYPE(char, H5T_NATIVE_INT8, H5T_STD_I8LE)
#undef POLDER_HDF5_TYPE

Image::Image(fs::path path, std::size_t expected_bytes) : path_(std::move(path)) {
  silence();
  const Handle access = checked(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, path_, "file");
  const std::size_t increment = std::max<std::size_t>(expected_bytes, 1 << 16);
  require(H5Pset_fapl_core(access, increment, /*backing_store=*/0) >= 0, path_, "file");
  // Version 1.8 of the format: every piece of metadata carries a checksum, and what 1.10 adds (a mark "open
  // for writing" that only a regular close takes away) stays out.
  require(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18) >= 0, path_, "file");
  const auto untimed = [&](hid_t kind) {
    Handle creation = checked(H5Pcreate(kind), H5Pclose, path_, "file");
    require(H5Pset_obj_track_times(creation, /*track_times=*/0) >= 0, path_, "file");
    return creation;
  };
  group_creation_ = untimed(H5P_GROUP_CREATE);
  dataset_creation_ = untimed(H5P_DATASET_CREATE);
  file_ = checked(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, untimed(H5P_FILE_CREATE), access), H5Fclose, path_,
                  "file");
}

// HDF5 would make groups on the way by itself, but with their times.
void Image::groups_above(const std::string& name) {
  for (std::size_t slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1))
    group(name.substr(0, slash));
}

void Image::group(const std::string& name) {
  if (!groups_.insert(name).second) return;
  groups_above(name);
  checked(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, group_creation_, H5P_DEFAULT), H5Gclose, path_, name);
}

template <class T>
void Image::dataset(const std::string& name, std::span<const T> values, hsize_t columns, hid_t stored_type) {
  groups_above(name);
  const hsize_t dimensions[2] = {columns > 0 ? values.size() / columns : values.size(), columns};
  const Handle space =
      checked(H5Screate_simple(columns > 0 ? 2 : 1, dimensions, nullptr), H5Sclose, path_, name);
  const Handle set = checked(
      H5Dcreate2(file_, name.c_str(), stored_type, space, H5P_DEFAULT, dataset_creation_, H5P_DEFAULT),
      H5Dclose, path_, name);
  if (values.empty()) return;
  require(H5Dwrite(set, memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0, path_, name);
}

template <class T>
void Image::attribute(const std::string& object, const std::string& name, std::span<const T> values) {
  const hsize_t size = values.size();
  const Handle space = checked(H5Screate_simple(1, &size, nullptr), H5Sclose, path_, name);
  const Handle at = checked(H5Acreate_by_name(file_, object.c_str(), name.c_str(), file_type<T>(), space,
                                              H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                            H5Aclose, path_, object + "@" + name);
  require(H5Awrite(at, memory_type<T>(), values.data()) >= 0, path_, object + "@" + name);
}

void Image::attribute(const std::string& object, const std::string& name, const std::string& text) {
  const Handle type = checked(H5Tcopy(H5T_C_S1), H5Tclose, path_, name);
  require(H5Tset_size(type, std::max<std::size_t>(text.size(), 1)) >= 0, path_, name);
  require(H5Tset_strpad(type, H5T_STR_NULLPAD) >= 0, path_, name);
  const Handle space = checked(H5Screate(H5S_SCALAR), H5Sclose, path_, name);
  const Handle at = checked(H5Acreate_by_name(file_, object.c_str(), name.c_str(), type, space, H5P_DEFAULT,
                                              H5P_DEFAULT, H5P_DEFAULT),
                            H5Aclose, path_, object + "@" + name);
  require(H5Awrite(at, type, text.c_str()) >= 0, path_, object + "@" + name);
}

void Image::write() {
  require(H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0, path_, "file");
  // The core driver's handle is the address of its buffer: the file's bytes without another copy of them.
  void* handle = nullptr;
  require(H5Fget_vfd_handle(file_, H5P_DEFAULT, &handle) >= 0, path_, "file");
  // The buffer is larger than the file: it grows in steps. This asks for the file's size only.
  const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
  require(size > 0, path_, "file");
  write_file_atomically(path_, std::span(*static_cast<std::byte**>(handle), static_cast<std::size_t>(size)));
  file_.reset();
}

Reader::Reader(fs::path path) : path_(std::move(path)) {
  silence();
  struct stat status {};
  if (::stat(path_.c_str(), &status) != 0) throw_file_error(path_, "cannot be read", errno);
  const Handle access = checked(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, path_, "file");
  // Finished files never change, and some network file systems refuse locks.
  require(H5Pset_file_locking(access, /*use=*/false, /*ignore_when_disabled=*/true) >= 0, path_, "file");
  errno = 0;
  file_ = Handle(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
  if (!file_.valid() && (errno == EACCES || errno == EPERM)) throw_file_error(path_, "cannot be read", errno);
  if (!file_.valid()) {
    throw EnvironmentError(path_.string() +
                           ": is damaged, cut short or not an HDF5 file: " + library_reason());
  }
}

void Reader::fail(const std::string& object, const std::string& problem) const {
  fail_at(path_, object, problem);
}

bool Reader::has(const std::string& name) const {
  // H5Lexists wants every group on the way to exist.
  for (std::size_t slash = name.find('/', 1); slash != std::string::npos; slash = name.find('/', slash + 1)) {
    if (H5Lexists(file_, name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
  }
  return H5Lexists(file_, name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Reader::datasets() const {
  std::vector<std::string> names;
  const auto visit = [](hid_t, const char* name, const H5O_info_t* info, void* list) -> herr_t {
    if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  if (H5Ovisit2(file_, H5_INDEX_NAME, H5_ITER_INC, visit, &names, H5O_INFO_BASIC) < 0) {
    fail("list of arrays", "cannot be read, the file is damaged: " + library_reason());
  }
  return names;
}

std::string Reader::text_attribute(const std::string& object, const std::string& name) const {
  const Handle at(H5Aopen_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!at.valid()) return {};
  const Handle type(H5Aget_type(at), H5Tclose);
  if (!type.valid() || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0) return {};
  std::string text(H5Tget_size(type), '\0');
  if (H5Aread(at, type, text.data()) < 0) fail(object + "@" + name, "cannot be read: " + library_reason());
  while (!text.empty() && text.back() == '\0') text.pop_back();
  return text;
}

template <class T>
std::vector<T> Reader::attribute(const std::string& object, const std::string& name) const {
  const Handle at(H5Aopen_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!at.valid()) return {};
  const Handle space(H5Aget_space(at), H5Sclose);
  const hssize_t size = H5Sget_simple_extent_npoints(space);
  std::vector<T> values(size > 0 ? static_cast<std::size_t>(size) : 0);
  if (values.empty()) return values;
  if (H5Aread(at, memory_type<T>(), values.data()) < 0) {
    fail(object + "@" + name, "cannot be read: " + library_reason());
  }
  return values;
}

template <class T>
std::vector<T> Reader::dataset(const std::string& name, bool exact) const {
  if (!has(name)) fail(name, "is missing");
  const Handle set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.valid()) fail(name, "cannot be opened, the file is damaged: " + library_reason());
  const Handle type(H5Dget_type(set), H5Tclose);
  if (exact && H5Tequal(type, file_type<T>()) <= 0) fail(name, "holds values of another type than expected");
  const Handle space(H5Dget_space(set), H5Sclose);
  const hssize_t size = H5Sget_simple_extent_npoints(space);
  if (size < 0) fail(name, "cannot be read: " + library_reason());
  std::vector<T> values(static_cast<std::size_t>(size));
  if (!values.empty() && H5Dread(set, memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    fail(name, "cannot be read, the file is damaged: " + library_reason());
  }
  return values;
}

std::vector<std::byte> Reader::raw(const std::string& name) const {
  const Handle set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.valid()) fail(name, "cannot be opened, the file is damaged: " + library_reason());
  const Handle type(H5Dget_type(set), H5Tclose);
  const Handle space(H5Dget_space(set), H5Sclose);
  const hssize_t size = H5Sget_simple_extent_npoints(space);
  if (!type.valid() || size < 0) fail(name, "cannot be read: " + library_reason());
  std::vector<std::byte> bytes(static_cast<std::size_t>(size) * H5Tget_size(type));
  if (!bytes.empty() && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0) {
    fail(name, "cannot be read, the file is damaged: " + library_reason());
  }
  return bytes;
}

#define POLDER_HDF5_INSTANTIATE(T)                                                               \
  template void Image::dataset<T>(const std::string&, std::span<const T>, hsize_t, hid_t);       \
  template void Image::attribute<T>(const std::string&, const std::string&, std::span<const T>); \
  template std::vector<T> Reader::attribute<T>(const std::string&, const std::string&) const;    \
  template std::vector<T> Reader::dataset<T>(const std::string&, bool) const;
POLDER_HDF5_INSTANTIATE(double)
POLDER_HDF5_INSTANTIATE(float)
POLDER_HDF5_INSTANTIATE(std::int32_t)
POLDER_HDF5_INSTANTIATE(std::int64_t)
POLDER_HDF5_INSTANTIATE(std::uint64_t)
POLDER_HDF5_INSTANTIATE(std::uint8_t)
POLDER_HDF5_INSTANTIATE(char)
#undef POLDER_HDF5_INSTANTIATE

}  // namespace polder::hdf5
