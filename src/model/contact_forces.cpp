#include "model/contact_forces.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/expression_matrix.hpp"
#include "model/model_completion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

constexpr double negligible_share = 1e-9; ///< of a slip in another one

} // namespace

std::vector<Expression> accelerations_by(const std::vector<Expression>& mass, const std::vector<Expression>& forces) {
    const std::size_t n = forces.size();
    std::vector<Expression> result;
    if (mass.size() == n) {
        for (std::size_t i = 0; i < n; ++i)
            result.push_back(forces[i] / mass[i]);
        return result;
    }
    ExpressionMatrix rows(n);
    for (std::size_t i = 0; i < n; ++i) {
        rows[i].assign(mass.begin() + static_cast<std::ptrdiff_t>(i * n),
                       mass.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
        rows[i].push_back(forces[i]);
    }
    eliminate(rows, forces.front().graph()->number(1));
    for (const auto& row : rows)
        result.push_back(row.back());
    return result;
}

std::vector<ContactStates> combinations(const std::vector<std::vector<ContactState>>& options) {
    std::vector<ContactStates> result{{}};
    for (const std::vector<ContactState>& states : options) {
        std::vector<ContactStates> longer;
        for (const ContactStates& one : result)
            for (const ContactState state : states) {
                longer.push_back(one);
                longer.back().push_back(state);
            }
        result = std::move(longer);
    }
    return result;
}

std::string contact_words(const std::string& contact, ContactState state) {
    constexpr std::string_view words[] = {"", "", "-stick", "-forward", "-backward"};
    return state == ContactState::open ? "" : fmt::format("-{}{}", contact, words[static_cast<std::size_t>(state)]);
}

ContactMechanics::ContactMechanics(Model& model, const Places& places, SurfaceMotion& motion, std::size_t mode)
    : model_(model), places_(places), motion_(motion), velocities_(model.contact_settings.velocities),
      mass_(motion.expanded(model.contact_settings.mass)), field_(motion.expanded(model.modes[mode].rates)),
      directions_(model) {
    for (const std::size_t state : velocities_)
        symbols_.push_back(model.symbol(model.states[state].name));
    require_positive_masses();
    for (const UnilateralContact& contact : model.contacts) {
        const std::string path = "contacts." + contact.name;
        gaps_.push_back(motion.expanded(contact.gap));
        for (std::size_t i = 0; i < symbols_.size(); ++i)
            if (!differentiate(gaps_.back(), symbols_[i]).is_number(0))
                throw InputError(places.of(path + ".gap"),
                                 fmt::format("the gap of '{}' depends on the velocity '{}', which impulses change",
                                             contact.name, model.states[velocities_[i]].name),
                                 "give it in terms of positions");
        ContactDirection normal = direction_of(motion.rate_along(gaps_.back(), field_), path + ".gap",
                                               fmt::format("the rate of the gap of '{}'", contact.name));
        friction_.push_back(contact.friction ? motion.expanded(*contact.friction) : model.number(0));
        std::optional<ContactDirection> slip;
        if (contact.slip)
            slip = direction_of(motion.expanded(*contact.slip), path + ".slip",
                                fmt::format("the slip of '{}'", contact.name));
        directions_.add_contact(std::move(normal), std::move(slip));
    }
    directions_.note(symbols_, gaps_);
}

void ContactMechanics::require_positive_masses() const {
    const std::size_t n = velocities_.size();
    const std::vector<double> mass = values_at_start(model_, mass_);
    if (std::ranges::any_of(mass, [](double value) { return !std::isfinite(value); }))
        return; // `validate` tells what is wrong with the initial state
    std::vector<double> matrix(n * n, 0.0);
    for (std::size_t i = 0; i < mass.size(); ++i)
        matrix[mass.size() == n ? i * (n + 1) : i] = mass[i];
    if (!has_positive_pivots(std::move(matrix), n, 0))
        throw InputError(places_.of("contacts.mass"), "the mass matrix is not positive definite at the initial state",
                         "give masses and moments of inertia, which are positive");
}

ContactDirection ContactMechanics::direction_of(const Expression& velocity, const std::string& path,
                                                const std::string& what) const {
    ContactDirection direction{.velocity = velocity};
    for (const Expression& symbol : symbols_)
        direction.slopes.push_back(differentiate(velocity, symbol));
    require_linear(direction, path, what);
    direction.response = accelerations_by(mass_, direction.slopes);
    direction.acceleration = motion_.rate_along(velocity, field_);
    return direction;
}

/// Impulses are proportional to changes of velocities only if these enter linearly.
void ContactMechanics::require_linear(const ContactDirection& direction, const std::string& path,
                                      const std::string& what) const {
    if (std::ranges::all_of(direction.slopes, [](const Expression& slope) { return slope.is_number(0); }))
        throw InputError(places_.of(path), what + " does not depend on a velocity",
                         "name in `velocities` the states that impulses change, and give the gap in terms of positions "
                         "whose rates contain them");
    for (const Expression& slope : direction.slopes)
        for (const Expression& symbol : symbols_)
            if (contains_symbol(slope, symbol))
                throw InputError(places_.of(path), fmt::format("{} is not linear in '{}'", what, symbol.name()),
                                 "give the gap in terms of positions, and velocities in which their rates are linear");
}

ContactForces ContactMechanics::solve(const ContactStates& states, const std::vector<Expression>& normal_changes,
                                      const std::vector<Expression>& tangential_changes) const {
    const Expression zero = model_.number(0), one = model_.number(1);
    const Held held = this->held(states).value();
    std::vector<std::size_t> equations;
    std::vector<std::vector<Expression>> columns;
    std::vector<Expression> wanted;
    ContactForces result;
    for (std::size_t i = 0; i < states.size(); ++i) {
        if (states[i] == ContactState::open)
            continue;
        equations.push_back(2 * i);
        wanted.push_back(normal_changes[i]);
        columns.push_back(normal(i).response);
        if (is_slip(states[i])) {
            const Expression share = states[i] == ContactState::forward ? -friction_[i] : friction_[i];
            for (std::size_t k = 0; k < symbols_.size(); ++k)
                columns.back()[k] = columns.back()[k] + share * slip(i).response[k];
            result.regular.push_back(normal(i).along(columns.back()));
        }
        if (states[i] == ContactState::stick && !held.follows(i)) {
            equations.push_back(2 * i + 1);
            wanted.push_back(tangential_changes[i]);
            columns.push_back(slip(i).response);
        }
    }
    ExpressionMatrix rows(equations.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (const auto& column : columns)
            rows[i].push_back(directions_[equations[i]].along(column));
        rows[i].push_back(wanted[i]);
    }
    const Expression determinant = eliminate(rows, one);
    if (!result.regular.empty() && rows.size() > 1)
        result.regular.push_back(determinant);
    result.changes.assign(symbols_.size(), zero);
    result.normal.assign(states.size(), zero);
    result.tangential.assign(states.size(), zero);
    for (std::size_t row = 0; row < equations.size(); ++row) {
        const Expression& force = rows[row].back();
        for (std::size_t k = 0; k < symbols_.size(); ++k)
            result.changes[k] = result.changes[k] + columns[row][k] * force;
        const std::size_t i = equations[row] / 2;
        (equations[row] % 2 == 0 ? result.normal : result.tangential)[i] = force;
        if (is_slip(states[i]))
            result.tangential[i] = (states[i] == ContactState::forward ? -friction_[i] : friction_[i]) * force;
    }
    add_limits(states, held, result);
    for (const auto& [contact, dependence] : held.following) {
        Expression difference = tangential_changes[contact], squares = difference * difference;
        for (std::size_t k = 0; k < dependence.shares.size(); ++k) {
            const std::size_t i = held.directions[k] / 2;
            const Expression part =
                dependence.shares[k] * (held.directions[k] % 2 == 0 ? normal_changes : tangential_changes)[i];
            difference = difference - part;
            squares = squares + part * part;
        }
        result.joint.push_back(dependence.same);
        result.differences.push_back(difference);
        result.apart.push_back(ContactDirections::apart(difference, squares));
    }
    return result;
}

ContactForces ContactMechanics::forces(const ContactStates& states) const {
    std::vector<Expression> normal_changes, tangential_changes;
    for (std::size_t i = 0; i < states.size(); ++i) {
        normal_changes.push_back(-normal(i).acceleration);
        tangential_changes.push_back(rubs(i) ? -slip(i).acceleration : model_.number(0));
    }
    ContactForces result = solve(states, normal_changes, tangential_changes);
    result.differences.clear();
    result.apart.clear();
    const Held held = this->held(states).value();
    for (const auto& [contact, dependence] : held.following)
        if (!dependence.apart.is_number(0))
            result.apart.push_back(dependence.apart);
    return result;
}

/// Adds the ends of contact and of rest. A force of friction that may be chosen changes those of other contacts that
/// hold the same velocities.
void ContactMechanics::add_limits(const ContactStates& states, const Held& held, ContactForces& to) const {
    std::vector<SharedContact> shared;
    for (std::size_t i = 0; i < states.size(); ++i) {
        if (states[i] == ContactState::open)
            continue;
        const bool sticks = states[i] == ContactState::stick;
        SharedContact one{i, sticks, friction_[i], {to.normal[i], {}}, {to.tangential[i], {}}};
        bool changes = false;
        for (const auto& [contact, dependence] : held.following) {
            one.normal.by.push_back(-held.share(dependence, 2 * i, model_.number(0)));
            one.tangential.by.push_back(
                contact == i ? model_.number(1)
                             : (sticks ? -held.share(dependence, 2 * i + 1, model_.number(0)) : model_.number(0)));
            changes = changes || !one.normal.by.back().is_number(0) || !one.tangential.by.back().is_number(0);
        }
        if (changes) {
            shared.push_back(std::move(one));
            continue;
        }
        to.limits.push_back({to.normal[i], {{i, ContactState::open}}, model_.number(0)});
        if (sticks)
            for (const ContactState beyond : {ContactState::forward, ContactState::backward}) {
                const Expression most = friction_[i] * to.normal[i];
                to.limits.push_back(
                    {beyond == ContactState::forward ? most + to.tangential[i] : most - to.tangential[i],
                     {{i, beyond}},
                     model_.number(0)});
            }
    }
    JointLimits joint = joint_limits(directions_.start(), shared);
    to.limits.insert(to.limits.end(), joint.limits.begin(), joint.limits.end());
    std::ranges::stable_sort(to.limits, {}, [](const ContactLimit& limit) { return limit.beyond.front(); });
    to.joint = std::move(joint.regular);
}

bool ContactMechanics::Held::follows(std::size_t contact) const {
    return std::ranges::any_of(following, [&](const auto& one) { return one.first == contact; });
}

Expression ContactMechanics::Held::share(const DirectionDependence& dependence, std::size_t direction,
                                         const Expression& zero) const {
    const auto found = std::ranges::find(directions, direction);
    const auto k = static_cast<std::size_t>(found - directions.begin());
    return found == directions.end() || k >= dependence.shares.size() ? zero : dependence.shares[k];
}

std::optional<ContactMechanics::Held> ContactMechanics::held(const ContactStates& states) const {
    Held result;
    for (std::size_t i = 0; i < states.size(); ++i)
        if (states[i] != ContactState::open)
            result.directions.push_back(2 * i);
    if (!directions_.independent(result.directions))
        return std::nullopt;
    for (std::size_t i = 0; i < states.size(); ++i) {
        if (states[i] != ContactState::stick)
            continue;
        const auto dependence = directions_.dependence(2 * i + 1, result.directions);
        if (!dependence) {
            result.directions.push_back(2 * i + 1);
            continue;
        }
        for (const Expression& state : model_.state_symbols())
            if (contains_symbol(dependence->apart, state))
                return std::nullopt;
        for (std::size_t k = 0; k < dependence->shares.size(); ++k)
            if (!dependence->shares[k].is_number(0) && is_slip(states[result.directions[k] / 2]))
                return std::nullopt; // how friction is shared would change the motion
        result.following.emplace_back(i, *dependence);
    }
    return result;
}

bool ContactMechanics::can_slip(const ContactStates& states) const {
    const auto held = this->held(states);
    if (!held || std::ranges::any_of(held->following, [](const auto& one) {
            const Expression& apart = one.second.apart;
            return apart.is_number() && !apart.is_number(0); // belts of different speeds
        }))
        return false;
    std::vector<std::size_t> slipping;
    for (std::size_t i = 0; i < states.size(); ++i)
        if (is_slip(states[i]))
            slipping.push_back(i);
    const auto sign = [&](std::size_t contact) { return states[contact] == ContactState::forward ? 1 : -1; };
    for (std::size_t set = 1; set < std::size_t{1} << slipping.size(); ++set) {
        std::vector<std::size_t> others = held->directions, members;
        for (std::size_t k = 0; k < slipping.size(); ++k)
            if ((set >> k & 1U) != 0)
                members.push_back(slipping[k]);
        const std::size_t last = members.back();
        members.pop_back();
        for (const std::size_t contact : members)
            others.push_back(2 * contact + 1);
        if (!directions_.independent(others))
            continue;
        const auto follows = directions_.dependence(2 * last + 1, others);
        if (!follows || !follows->everywhere || !follows->apart.is_number(0))
            continue;
        bool against = true; // all parts of the last slip have the direction that it has not
        for (std::size_t k = 0; k < members.size(); ++k)
            against = against &&
                      follows->at_start[held->directions.size() + k] * sign(members[k]) * sign(last) < negligible_share;
        if (against)
            return false;
    }
    return true;
}

std::optional<ContactMechanics::FollowingSlip> ContactMechanics::following_slip(std::size_t contact,
                                                                                ContactStates states) const {
    states[contact] = ContactState::closed;
    const auto held = this->held(states);
    if (!held)
        return std::nullopt;
    std::vector<std::size_t> others = held->directions;
    if (const auto follows = directions_.dependence(2 * contact + 1, others); follows && follows->everywhere)
        return FollowingSlip{ContactState::stick, follows->apart};
    for (std::size_t i = 0; i < states.size(); ++i) {
        if (!is_slip(states[i]))
            continue;
        others.push_back(2 * i + 1);
        if (directions_.independent(others))
            if (const auto follows = directions_.dependence(2 * contact + 1, others); follows && follows->everywhere) {
                const bool same = follows->at_start.back() > 0;
                return FollowingSlip{same == (states[i] == ContactState::forward) ? ContactState::forward
                                                                                  : ContactState::backward,
                                     follows->apart};
            }
        others.pop_back();
    }
    return std::nullopt;
}

} // namespace graze
