// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace jobs {

/// Machine and program that computed a result. Results are equal to the bit where cpu, libm, numerics and the
/// program's engine are.
struct Provenance {
  std::string host, cpu;
  std::string libm;      ///< the mathematical library of the C library: "glibc 2.36"
  /// Variant of libm: "native" (the fastest that the processor has) or "portable"
  std::string numerics;
  std::string version, commit, compiler;  ///< of the program
  std::string engine;                     ///< part of the name of a result's content
};

/// Provenance of the results of this process.
[[nodiscard]] const Provenance& own_provenance();

// The mathematical library picks the variants of its functions (sin, exp, pow) that suit the processor, when
// a program starts. They differ in the last bit of some results, so that two kinds of processors give two
// answers. Portable numerics take the variants that every x86-64 processor has: one answer everywhere.

/// The value of GLIBC_TUNABLES with which a program starts in portable numerics: it keeps what is set
/// already.
[[nodiscard]] std::string portable_tunables();
/// @returns whether this process was started in portable numerics
[[nodiscard]] bool has_portable_numerics();

/// Engine's part of this process's contents: the engine's version and, if they are portable, its numerics.
[[nodiscard]] const std::string& engine_version();

}  // namespace jobs
