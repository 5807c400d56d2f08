#include "graze/sweep/sampling.hpp"

namespace graze {

void SampleSet::clear() {
    samplings.clear();
    times.clear();
    values.clear();
}

} // namespace graze
