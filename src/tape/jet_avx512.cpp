#if defined(__x86_64__)
#define GRAZE_INSTRUCTION_SET avx512
#define GRAZE_LANES 8
#include "tape/kernels_of_set.hpp"
#endif
