#include "branch/branch_follower.hpp"
#include "branch/family.hpp"

#include <utility>

namespace graze {

namespace {

/// Follows a family of orbits as a branch of its unfolded model, and tells its points as those of the model itself.
class FamilyFollower : public BranchFollower {
public:
    FamilyFollower(Family family, BranchSettings settings)
        : family_(std::move(family)), inner_(follower_of_orbits(family_.system(), family_.start(), settings)) {}

    bool start() override { return take(inner_->start()); }
    bool start_along(const OrbitDirection& direction, double distance) override {
        return take(inner_->start_along(direction, distance));
    }
    bool step() override { return take(inner_->step()); }
    const BranchPoint& point() const override { return point_; }

private:
    bool take(bool there) {
        found_.clear();
        finish(inner_->how_ended(), inner_->why_ended());
        if (!there)
            return false;
        const BranchPoint before = std::exchange(point_, inner_->point());
        family_.fold(point_);
        found_ = inner_->found_points();
        for (SpecialPoint& special : found_)
            family_.fold(special, before, point_);
        return true;
    }

    Family family_;
    std::unique_ptr<BranchFollower> inner_;
    BranchPoint point_;
};

} // namespace

std::unique_ptr<BranchFollower> follower_of_family(const System& system, const Orbit& candidate,
                                                   const BranchSettings& settings) {
    std::optional<Family> family = Family::of(system, candidate, settings);
    if (!family)
        return nullptr;
    BranchSettings unfolded = family->settings();
    if (unfolded.kept)
        unfolded.kept = family->unfolded(*unfolded.kept);
    return std::make_unique<FamilyFollower>(std::move(*family), std::move(unfolded));
}

} // namespace graze
