// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace jobs {

// The build fills these in when it is configured: program_info.cc.in, packaging/version.cmake.
extern const std::string_view kProgramVersion;      ///< 0.1.0+12: the last version and the commits since then
extern const std::string_view kProgramVersionText;  ///< with the commit: 0.1.0+12.g0123456789ab
/// 0123456789ab or, with changes, 0123456789ab-dirty; unknown without Git
extern const std::string_view kProgramCommit;
extern const std::string_view kProgramCompiler;

/// Identity of results: version, and a hash of the engine's sources, the compiler, its options, and the
/// versions of Eigen and Boost.
extern const std::string_view kEngineVersion;

}  // namespace jobs
