// SPDX-License-Identifier: Apache-2.0
#pragma once

// Before a function: one build of it for every x86-64 machine, and one for those with AVX2; the loader picks.
// Only for functions whose results are the same bits either way: integers, and reals with no operation fused
// or reordered (-ffp-contract=off). Sanitizers run before the resolver can, and get the first.
//
// GCC exports such a function whatever its visibility. If a header declares it, it goes into the inline
// namespace `multiversion`, which src/hidden.map keeps out of shared libraries' tables.
#if defined(__x86_64__) && defined(__linux__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
#define GRIDMERGE_MULTIVERSION __attribute__((target_clones("avx2", "default")))
#else
#define GRIDMERGE_MULTIVERSION
#endif
