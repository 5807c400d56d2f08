#include "graze/sweep/attractor.hpp"

namespace graze {

std::string_view name_of(Label label) {
    switch (label) {
    case Label::periodic:
        return "periodic";
    case Label::quasi_periodic:
        return "quasi-periodic";
    case Label::chaotic:
        return "chaotic";
    case Label::equilibrium:
        return "equilibrium";
    case Label::unbounded:
        return "unbounded";
    case Label::unsettled:
        return "unsettled";
    case Label::escaped:
        return "escaped";
    case Label::singular:
        return "singular";
    case Label::chattering:
        return "chattering";
    case Label::ended:
        return "ended";
    case Label::failed:
        return "failed";
    }
    return "unsettled";
}

} // namespace graze
