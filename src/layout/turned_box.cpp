#include "layout/turned_box.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

TurnedBox::TurnedBox(const GridBox& box, GridPoint at, double angle) {
    const double cosine = std::cos(angle), sine = std::sin(angle);
    std::size_t i = 0;
    for (const GridPoint& corner : polygon_of(box)) {
        const auto x = static_cast<double>(corner.x), y = static_cast<double>(corner.y);
        corners_[i++] = {static_cast<double>(at.x) + cosine * x - sine * y,
                         static_cast<double>(at.y) + sine * x + cosine * y};
    }
    middle_ = {(corners_[0].x + corners_[2].x) / 2, (corners_[0].y + corners_[2].y) / 2};
    reach_ = std::hypot(corners_[0].x - middle_.x, corners_[0].y - middle_.y);
}

bool TurnedBox::keeps_off(const TurnedBox& other) const {
    constexpr double alike = 1; // nanometres: corners are rounded
    for (std::size_t i = 0; i < corners_.size(); ++i) {
        const BoxCorner &a = corners_[i], &b = corners_[(i + 1) % corners_.size()];
        const double length = std::hypot(b.x - a.x, b.y - a.y);
        if (length > 0 && std::all_of(other.corners_.begin(), other.corners_.end(), [&](const BoxCorner& c) {
                return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) <= alike * length;
            }))
            return true;
    }
    return false;
}

bool TurnedBox::meets(const TurnedBox& other) const {
    if (std::hypot(middle_.x - other.middle_.x, middle_.y - other.middle_.y) > reach_ + other.reach_)
        return false;
    return !keeps_off(other) && !other.keeps_off(*this);
}

} // namespace graze
