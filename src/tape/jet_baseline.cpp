#define GRAZE_INSTRUCTION_SET baseline
#define GRAZE_LANES 2
#include "tape/kernels_of_set.hpp"
