#include "io/checkpoint.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <variant>

#include "core/error.hpp"
#include "io/hash.hpp"
#include "io/hdf5_file.hpp"

namespace polder {
namespace fs = std::filesystem;
namespace {

constexpr char kRoot[] = "/";
constexpr char kKind[] = "polder_checkpoint";  // attribute that tells a checkpoint from other HDF5 files
constexpr char kProgram[] = "program_version";
constexpr char kCaseHash[] = "case_hash";
constexpr char kChecksum[] = "checksum";
constexpr char kArrays[] = "number_of_arrays";
// The texts of the writer itself, out of the way of the caller's names.
constexpr char kCaseText[] = "polder/resolved_case";

// "line 7: 'a = 1' in the checkpoint, 'a = 2' now"
std::string first_difference(std::string_view stored, std::string_view now) {
  const auto next_line = [](std::string_view& text) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    return line;
  };
  const auto quoted = [](bool present, std::string_view line) {
    return present ? "'" + std::string(line) + "'" : std::string("nothing");
  };
  for (int number = 1;; ++number) {
    const bool more_stored = !stored.empty(), more_now = !now.empty();
    if (!more_stored && !more_now) return "only the end of the last line differs";
    const std::string_view a = next_line(stored), b = next_line(now);
    if (a != b || more_stored != more_now) {
      return "line " + std::to_string(number) + " of the resolved case is " + quoted(more_stored, a) +
             " in the checkpoint and " + quoted(more_now, b) + " now";
    }
  }
}

}  // namespace

struct CheckpointWriter::State {
  using Values = std::variant<std::vector<double>, std::vector<std::int32_t>, std::vector<std::int64_t>,
                              std::vector<std::uint64_t>, std::vector<char>>;

  template <class T>
  void put(const std::string& name, std::span<const T> values) {
    if (name.empty() || !names.insert(name).second) {
      throw std::invalid_argument("checkpoint: the name '" + name + "' is empty or used twice");
    }
    bytes += values.size_bytes();
    arrays.emplace_back(name, std::vector<T>(values.begin(), values.end()));
  }

  fs::path path;
  std::string program_version;
  std::uint64_t case_hash = 0;
  std::vector<std::pair<std::string, Values>> arrays;
  std::set<std::string> names;
  std::size_t bytes = 0;
};

CheckpointWriter::CheckpointWriter(fs::path path, std::string_view program_version,
                                   std::string_view resolved_case)
    : state_(std::make_unique<State>()) {
  state_->path = std::move(path);
  state_->program_version = program_version;
  state_->case_hash = hash_text(resolved_case);
  put_text(kCaseText, resolved_case);
}

CheckpointWriter::~CheckpointWriter() = default;

void CheckpointWriter::put(const std::string& name, std::span<const double> values) {
  state_->put(name, values);
}
void CheckpointWriter::put(const std::string& name, std::span<const std::int32_t> values) {
  state_->put(name, values);
}
void CheckpointWriter::put(const std::string& name, std::span<const std::int64_t> values) {
  state_->put(name, values);
}
void CheckpointWriter::put(const std::string& name, std::span<const std::uint64_t> values) {
  state_->put(name, values);
}
void CheckpointWriter::put(const std::string& name, std::span<const char> values) {
  state_->put(name, values);
}

void CheckpointWriter::put_text(const std::string& name, std::string_view text) {
  state_->put(name, std::span<const char>(text.data(), text.size()));
}

void CheckpointWriter::commit() {
  hdf5::Image image(state_->path, state_->bytes + state_->arrays.size() * 512 + (1 << 16));
  image.attribute(kRoot, kKind, std::span<const std::int64_t>(&kCheckpointFormat, 1));
  image.attribute(kRoot, kProgram, state_->program_version);
  image.attribute(kRoot, kCaseHash, std::span<const std::uint64_t>(&state_->case_hash, 1));
  for (auto& [name, array] : state_->arrays) {
    std::visit(
        [&, &name = name]<class T>(std::vector<T>& values) {
          const std::span<const T> all(values);
          image.dataset(name, all);
          const std::uint64_t checksum = hash_bytes(all.data(), all.size_bytes());
          image.attribute(name, kChecksum, std::span<const std::uint64_t>(&checksum, 1));
          std::vector<T>().swap(values);  // the image has them: no two copies of everything
        },
        array);
  }
  const auto arrays = static_cast<std::int64_t>(state_->arrays.size());
  image.attribute(kRoot, kArrays, std::span<const std::int64_t>(&arrays, 1));
  image.write();
}

struct CheckpointReader::State {
  explicit State(fs::path path) : file(std::move(path)) {
    const auto format = file.attribute<std::int64_t>(kRoot, kKind);
    if (format.size() != 1) fail("is not a checkpoint of Polder");
    if (format[0] != kCheckpointFormat) {
      fail("has checkpoint format " + std::to_string(format[0]) + ", this program reads format " +
           std::to_string(kCheckpointFormat));
    }
    program_version = file.text_attribute(kRoot, kProgram);
    const auto hash = file.attribute<std::uint64_t>(kRoot, kCaseHash);
    const auto arrays = file.attribute<std::int64_t>(kRoot, kArrays);
    names = file.datasets();
    if (hash.size() != 1 || arrays.size() != 1 || arrays[0] != static_cast<std::int64_t>(names.size())) {
      fail("is damaged: " + std::to_string(names.size()) + " arrays found, " +
           (arrays.empty() ? std::string("an unknown number") : std::to_string(arrays[0])) + " expected");
    }
    case_hash = hash[0];
    for (const std::string& name : names) {
      const auto checksum = file.attribute<std::uint64_t>(name, kChecksum);
      const std::vector<std::byte> bytes = file.raw(name);
      if (checksum.size() != 1 || checksum[0] != hash_bytes(bytes.data(), bytes.size())) {
        fail(name + ": is damaged (the checksum does not fit)");
      }
    }
    const std::vector<char> text = file.dataset<char>(kCaseText, true);
    resolved_case.assign(text.begin(), text.end());
    if (hash_text(resolved_case) != case_hash) fail("is damaged: the hash of the case does not fit");
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw EnvironmentError(file.path().string() + ": " + problem);
  }

  hdf5::Reader file;
  std::string program_version, resolved_case;
  std::uint64_t case_hash = 0;
  std::vector<std::string> names;
};

CheckpointReader::CheckpointReader(fs::path path) : state_(std::make_unique<State>(std::move(path))) {}
CheckpointReader::~CheckpointReader() = default;

const std::string& CheckpointReader::program_version() const {
  return state_->program_version;
}
const std::string& CheckpointReader::resolved_case() const {
  return state_->resolved_case;
}
std::uint64_t CheckpointReader::case_hash() const {
  return state_->case_hash;
}

void CheckpointReader::require_case(std::string_view resolved_case) const {
  if (resolved_case == state_->resolved_case) return;
  throw InputError(state_->file.path().string() +
                   ": belongs to another case: " + first_difference(state_->resolved_case, resolved_case));
}

bool CheckpointReader::has(const std::string& name) const {
  return std::find(state_->names.begin(), state_->names.end(), name) != state_->names.end();
}

std::vector<std::string> CheckpointReader::names() const {
  std::vector<std::string> names = state_->names;
  std::erase(names, kCaseText);
  return names;
}

template <class T>
requires detail::kCheckpointType<T> std::vector<T> CheckpointReader::array(const std::string& name)
const {
  return state_->file.dataset<T>(name, /*exact=*/true);
}

template <class T>
requires detail::kCheckpointType<T>
void CheckpointReader::read(const std::string& name, std::span<T> values) const {
  const std::vector<T> stored = array<T>(name);
  if (stored.size() != values.size()) {
    state_->fail(name + ": holds " + std::to_string(stored.size()) + " values, " +
                 std::to_string(values.size()) + " expected");
  }
  std::copy(stored.begin(), stored.end(), values.begin());
}

template <class T>
requires detail::kCheckpointType<T> T CheckpointReader::number(const std::string& name)
const {
  T value{};
  read(name, std::span<T>(&value, 1));
  return value;
}

std::string CheckpointReader::text(const std::string& name) const {
  const std::vector<char> text = array<char>(name);
  return {text.begin(), text.end()};
}

#define POLDER_CHECKPOINT_INSTANTIATE(T)                                           \
  template std::vector<T> CheckpointReader::array<T>(const std::string&) const;    \
  template void CheckpointReader::read<T>(const std::string&, std::span<T>) const; \
  template T CheckpointReader::number<T>(const std::string&) const;
POLDER_CHECKPOINT_INSTANTIATE(double)
POLDER_CHECKPOINT_INSTANTIATE(std::int32_t)
POLDER_CHECKPOINT_INSTANTIATE(std::int64_t)
POLDER_CHECKPOINT_INSTANTIATE(std::uint64_t)
POLDER_CHECKPOINT_INSTANTIATE(char)
#undef POLDER_CHECKPOINT_INSTANTIATE

}  // namespace polder
