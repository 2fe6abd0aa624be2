#include "app/nearest.hpp"

#include <algorithm>
#include <cctype>

namespace polder::app {
namespace {

// Words longer than this are not misspelt names; comparing them would only cost time.
constexpr std::size_t kLongest = 64;

std::string folded(const std::string& word) {
  std::string out;
  for (const char c : word)
    out += c == '-' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

}  // namespace

int edit_distance(const std::string& first, const std::string& second) {
  const std::string a = folded(first), b = folded(second);
  const std::size_t n = a.size(), m = b.size();
  std::vector<std::vector<int>> d(n + 1, std::vector<int>(m + 1));
  for (std::size_t i = 0; i <= n; ++i) d[i][0] = static_cast<int>(i);
  for (std::size_t j = 0; j <= m; ++j) d[0][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= n; ++i)
    for (std::size_t j = 1; j <= m; ++j) {
      const int replace = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[n][m];
}

std::string nearest_name(const std::string& word, const std::vector<std::string>& names) {
  if (word.empty() || word.size() > kLongest) return {};
  // One letter in three may be wrong, in words of three and more: of "z" nobody can tell what was meant.
  if (word.size() < 3) return {};
  int best = static_cast<int>(word.size()) / 3 + 1;
  std::string nearest;
  for (const std::string& name : names) {
    int distance = edit_distance(word, name);
    // A word that was cut short or lengthened: "friction_angle" for "friction".
    const std::string a = folded(word), b = folded(name);
    if (distance >= best && std::min(a.size(), b.size()) >= 4 && (a.starts_with(b) || b.starts_with(a)))
      distance = best - 1;
    if (distance < best) {
      best = distance;
      nearest = name;
    }
  }
  return nearest;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& names) {
  const std::string name = nearest_name(word, names);
  return name.empty() ? "" : ", did you mean \"" + name + "\"?";
}

std::string join(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : separator) + w;
  return text;
}

}  // namespace polder::app
