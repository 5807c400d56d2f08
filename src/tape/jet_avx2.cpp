#if defined(__x86_64__)
#define GRAZE_INSTRUCTION_SET avx2
#define GRAZE_LANES 4
#include "tape/kernels_of_set.hpp"
#endif
