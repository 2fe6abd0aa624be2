// A 64-bit hash of bytes: checksums of checkpoint arrays and the fingerprint of the resolved case.
//
// It finds damage and differences; it does not resist anyone who forges them. Every step is a bijection of
// the state for a given input and of the input for a given state, so damage inside one 8-byte word is always
// found and other damage is missed with probability 2^-64. The value depends on the bytes only, on every
// little-endian machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace polder {

inline std::uint64_t hash_bytes(const void* data, std::size_t bytes) {
  constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15ull;  // 2^64 / golden ratio: spreads neighbouring inputs
  const auto mix = [](std::uint64_t state, std::uint64_t word) {
    state = (state ^ word) * kOdd;
    return state ^ (state >> 32);
  };
  const unsigned char* at = static_cast<const unsigned char*>(data);
  std::uint64_t state = mix(kOdd, bytes);
  std::uint64_t word = 0;
  for (; bytes >= sizeof word; at += sizeof word, bytes -= sizeof word) {
    std::memcpy(&word, at, sizeof word);
    state = mix(state, word);
  }
  if (bytes > 0) {
    word = 0;
    std::memcpy(&word, at, bytes);
    state = mix(state, word);
  }
  return mix(mix(state, 0), 0);
}

inline std::uint64_t hash_text(std::string_view text) {
  return hash_bytes(text.data(), text.size());
}

}  // namespace polder
