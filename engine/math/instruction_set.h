// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The equations of motion are compiled once for each instruction set (dynamics/kernel/compiled_kernel.cc), and the program picks one as it starts. All
/// that is compiled so stands in a namespace of its own: inline functions that the linker takes for the same would otherwise bring AVX2
/// code to a machine without it.
#ifndef RPSUP_INSTRUCTION_SET
#define RPSUP_INSTRUCTION_SET baseline
#endif

#define RPSUP_INLINE [[gnu::always_inline]] inline
#define RPSUP_INLINE_LAMBDA __attribute__((always_inline))
