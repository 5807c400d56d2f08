#pragma once

#include "graze/atlas/atlas_findings.hpp"
#include "graze/picture/figure.hpp"
#include "picture/picture_kinds.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace graze {

/// Motions with the same look in pictures of an atlas: the most frequent periodic ones have classes of their own, the
/// others have one together; so have those that have not settled, and each other label.
struct AttractorClass {
    std::string name;                   ///< such as "period 1, 2 contacts", "chaotic"
    std::size_t colour = 0;             ///< of the palette, or `grey` or `black`
    DrawnAs drawn = DrawnAs::attractor; ///< what the motions show
    int symbol = FigureSeries().symbol; ///< of motions that have not settled
    int hatch = 0;                      ///< of cells: that of motions without an attractor
};

class AttractorClasses {
public:
    /// @param motions that are drawn
    /// @param others are distinguished as well where there is room, but do not count
    AttractorClasses(const std::vector<AtlasMotion>& motions, const std::vector<AtlasMotion>& others);

    const std::vector<AttractorClass>& all() const { return classes_; }
    std::size_t index_of(const AtlasMotion& motion) const { return indices_.at(motion.attractor()); }

private:
    std::vector<AttractorClass> classes_;
    std::map<std::string, std::size_t> indices_; ///< of classes, by what a motion does
};

} // namespace graze
