#pragma once

/// Functions of this kind are compiled twice, for processors with wide vectors and without; which is taken is found at load time.
/// Both give the same bytes: each element is computed by the same operations. ThreadSanitizer cannot work yet when that is found,
/// and a program with it would crash at its start.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define VERLET_CABLE_VECTOR_CODE __attribute__((target_clones("avx2", "default")))
#else
#define VERLET_CABLE_VECTOR_CODE
#endif
