// What was built: written anew by every build (version.cmake).
#pragma once

namespace polder::app {

extern const char* const kVersion;  // "0.1.0"
extern const char* const
    kCommit;  // "1a2b3c4d5e6f", with "+" if the sources were changed since; "" outside a repository
extern const char* const kBuildType;  // "Release"

}  // namespace polder::app
