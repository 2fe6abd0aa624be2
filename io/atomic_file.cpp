#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/error.hpp"

namespace polder {
namespace fs = std::filesystem;
namespace {

// Largest single write(); Linux transfers a little less than 2 GiB at most per call.
constexpr std::size_t kMaxWrite = std::size_t{1} << 30;

class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return descriptor_; }
  // Returns 0 or errno: some file systems report a full disk only here.
  int close() {
    if (descriptor_ < 0) return 0;
    const int result = ::close(descriptor_) == 0 ? 0 : errno;
    descriptor_ = -1;
    return result;
  }

 private:
  int descriptor_;
};

// Makes a rename in this folder survive a power cut. Some file systems cannot sync folders; the rename itself
// is then as durable as they make it.
void sync_folder(const fs::path& folder) {
  const Descriptor descriptor(
      ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (descriptor.get() >= 0) ::fsync(descriptor.get());
}

}  // namespace

void throw_file_error(const fs::path& path, const std::string& problem, int error_number) {
  throw EnvironmentError(path.string() + ": " + problem + ": " + std::strerror(error_number));
}

int write_fully(int descriptor, const void* data, std::size_t bytes) {
  const char* at = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = ::write(descriptor, at, std::min(bytes, kMaxWrite));
    if (written < 0) {
      if (errno == EINTR) continue;
      return errno;
    }
    at += written;
    bytes -= static_cast<std::size_t>(written);
  }
  return 0;
}

void write_file_atomically(const fs::path& path, std::span<const std::byte> content) {
  fs::path temporary = path;
  temporary += kTemporarySuffix;
  Descriptor descriptor(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (descriptor.get() < 0) throw_file_error(path, "cannot be written", errno);

  int error = write_fully(descriptor.get(), content.data(), content.size());
  if (error == 0 && ::fsync(descriptor.get()) != 0) error = errno;
  const int close_error = descriptor.close();
  if (error == 0) error = close_error;
  if (error == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    throw_file_error(path, "cannot be written", error);
  }
  sync_folder(path.parent_path());
}

void write_file_atomically(const fs::path& path, std::string_view content) {
  write_file_atomically(path, std::as_bytes(std::span(content)));
}

std::string read_file(const fs::path& path) {
  const Descriptor descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (descriptor.get() < 0) throw_file_error(path, "cannot be read", errno);
  std::string content;
  struct stat status {};
  if (::fstat(descriptor.get(), &status) == 0 && status.st_size > 0) content.reserve(status.st_size);
  char block[1 << 16];
  while (true) {
    const ssize_t got = ::read(descriptor.get(), block, sizeof block);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw_file_error(path, "cannot be read", errno);
    if (got == 0) return content;
    content.append(block, static_cast<std::size_t>(got));
  }
}

}  // namespace polder
