#include "graze/record/section.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/record/interpolate.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

SectionPoint section(const Period& period, double phase) {
    if (!(phase >= 0 && phase <= 1))
        throw InputError(fmt::format("the phase {} is not a part of a period", phase), "give a number from 0 to 1");
    const double time = period.begin + phase * period.duration();
    return {period.number, phase, time, interpolate(period.samples, time), false};
}

SectionPoint image_of(const SectionPoint& point, const RecordSymmetry& symmetry) {
    require_finite(symmetry.shift, "the shift of a symmetry");
    SectionPoint image = point;
    for (const std::size_t channel : symmetry.negated) {
        require_index(channel, image.values.size(), "channel");
        image.values[channel] = -image.values[channel];
    }
    image.phase = point.phase - symmetry.shift;
    image.phase -= std::floor(image.phase);
    image.image = true;
    return image;
}

SectionPoint image_section(const Period& period, double phase, const RecordSymmetry& symmetry) {
    const double later = phase + symmetry.shift;
    return image_of(section(period, later - std::floor(later)), symmetry);
}

} // namespace graze
