#include "graze/branch/special_point.hpp"

namespace graze {

std::string_view short_name(PointType type) {
    switch (type) {
    case PointType::fold:
        return "SN";
    case PointType::flip:
        return "PD";
    case PointType::torus:
        return "NS";
    case PointType::branch_point:
        return "BP";
    case PointType::asymmetry:
        return "SB";
    case PointType::grazing:
        return "GR";
    case PointType::vanishing:
        return "DZ";
    case PointType::two_events:
        return "EE";
    case PointType::guard:
        return "GU";
    case PointType::bound:
        return "BD";
    case PointType::crossing:
        return "UZ";
    case PointType::end:
        return "EP";
    case PointType::regular:
        return "RG";
    }
    return "";
}

std::string_view name_of(PointType type) {
    switch (type) {
    case PointType::fold:
        return "fold";
    case PointType::flip:
        return "flip";
    case PointType::torus:
        return "torus";
    case PointType::branch_point:
        return "branch point";
    case PointType::asymmetry:
        return "loss of symmetry";
    case PointType::grazing:
        return "grazing";
    case PointType::vanishing:
        return "vanishing segment";
    case PointType::two_events:
        return "two events at once";
    case PointType::guard:
        return "guard";
    case PointType::bound:
        return "bound";
    case PointType::crossing:
        return "crossing";
    case PointType::end:
        return "end";
    case PointType::regular:
        return "regular";
    }
    return "";
}

std::optional<PointType> point_type(std::string_view name) {
    for (int i = 0; i <= static_cast<int>(PointType::regular); ++i)
        if (name == short_name(static_cast<PointType>(i)))
            return static_cast<PointType>(i);
    return std::nullopt;
}

} // namespace graze
