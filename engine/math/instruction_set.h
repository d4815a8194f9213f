// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The dynamics kernel is compiled once for each instruction set (engine/dynamics/kernel), and the program
/// picks one as it starts, as with Google Highway. All code that the kernel includes is in an inline
/// namespace named after the instruction set: the linker would otherwise merge inline functions of the same
/// name, and bring AVX2 code to a machine without it.
#ifndef RPSUP_INSTRUCTION_SET
#define RPSUP_INSTRUCTION_SET baseline
#endif

#define RPSUP_INLINE [[gnu::always_inline]] inline
#define RPSUP_INLINE_LAMBDA __attribute__((always_inline))
