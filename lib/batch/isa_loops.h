// isa_loops.h -- loops that are compiled for several instruction sets; which one runs is chosen at run time (batch.h).
//
// Only the functions marked with an instruction set hold its instructions: everything else in a file that includes this, and whatever of
// the standard library the linker shares between files, is compiled for the machine that the whole library is built for. The marked ones
// get the loop by inlining (ISOPARM_INLINE), and the compiler's vectorizer makes of it what the instruction set can do. -ffp-contract=off
// keeps all of them equal to the bit.
#pragma once
#include <cmath>

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define ISOPARM_ISA_LOOPS 1
#define ISOPARM_FOR_AVX2 [[gnu::target("avx2")]]
// Everything between one of ISOPARM_BEGIN_... and ISOPARM_END_ISA is for that instruction set: vectors that are written out need that, as the compiler
// takes them apart before it inlines. Such loops stand in a file .inc; isa_copies.inc includes it once for each set.
#ifdef __clang__
#define ISOPARM_FOR_AVX512 [[gnu::target("avx512f,avx512dq,avx512vl")]]
#define ISOPARM_BEGIN_AVX2 _Pragma("clang attribute push(__attribute__((target(\"avx2\"))), apply_to = function)")
#define ISOPARM_BEGIN_AVX512 _Pragma("clang attribute push(__attribute__((target(\"avx512f,avx512dq,avx512vl\"))), apply_to = function)")
#define ISOPARM_END_ISA _Pragma("clang attribute pop")
#else
#define ISOPARM_FOR_AVX512 [[gnu::target("avx512f,avx512dq,avx512vl,prefer-vector-width=512")]]
#define ISOPARM_BEGIN_AVX2 _Pragma("GCC push_options") _Pragma("GCC target(\"avx2\")")
#define ISOPARM_BEGIN_AVX512 _Pragma("GCC push_options") _Pragma("GCC target(\"avx512f,avx512dq,avx512vl,prefer-vector-width=512\")")
#define ISOPARM_END_ISA _Pragma("GCC pop_options")
#endif
#endif
#define ISOPARM_INLINE [[gnu::always_inline]] inline
#define ISOPARM_INLINE_LAMBDA __attribute__((always_inline))
