#include "graze/results/run_kind.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace graze {

namespace {

/// What the points of runs of a kind are.
enum class Points { motions, attractors, one_orbit, orbits, measured };

struct KindOfRun {
    const char* name;
    Points points;
};

/// In the order of RunKind.
constexpr std::array all_kinds{
    KindOfRun{"simulate", Points::motions},      KindOfRun{"sweep", Points::attractors},
    KindOfRun{"basin", Points::attractors},      KindOfRun{"orbit", Points::one_orbit},
    KindOfRun{"equilibrium", Points::one_orbit}, KindOfRun{"continue", Points::orbits},
    KindOfRun{"curve", Points::orbits},          KindOfRun{"ladder", Points::orbits},
    KindOfRun{"torus", Points::orbits},          KindOfRun{"record", Points::measured},
    KindOfRun{"identify", Points::measured},     KindOfRun{"atlas", Points::attractors},
};

bool kind_has(RunKind kind, Points points) {
    const auto index = static_cast<std::size_t>(kind);
    return index < all_kinds.size() && all_kinds[index].points == points;
}

} // namespace

const std::vector<std::string>& kinds_of_runs() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const KindOfRun& kind : all_kinds)
            all.emplace_back(kind.name);
        return all;
    }();
    return names;
}

std::string_view name_of(RunKind kind) {
    const auto index = static_cast<std::size_t>(kind);
    return index < all_kinds.size() ? all_kinds[index].name : "unknown";
}

std::optional<RunKind> run_kind(std::string_view name) {
    const auto& names = kinds_of_runs();
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? std::nullopt : std::optional(static_cast<RunKind>(found - names.begin()));
}

bool has_motions(RunKind kind) {
    return kind_has(kind, Points::motions) || seeks_attractors(kind);
}

bool seeks_attractors(RunKind kind) {
    return kind_has(kind, Points::attractors);
}

bool is_swept(RunKind kind) {
    return kind == RunKind::sweep || kind == RunKind::atlas;
}

bool is_followed(RunKind kind) {
    return kind_has(kind, Points::orbits);
}

bool is_branch(RunKind kind) {
    return kind_has(kind, Points::one_orbit) || is_followed(kind);
}

bool is_measured(RunKind kind) {
    return kind_has(kind, Points::measured);
}

} // namespace graze
