#include "grazing/contact_effect.hpp"

#include "base/concatenated.hpp"
#include "orbit/certify.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace graze {

namespace {

constexpr std::size_t most_contacts = 20;
constexpr double never = std::numeric_limits<double>::infinity();

/// Follows one contact of approach speed s. States are those of the touch plus s times their gain; all functions are
/// linearised there except the touched one, which is expanded to second order.
class ContactFollower {
public:
    ContactFollower(const TouchFunctions& functions, const TouchState& touch, const TouchGeometry& geometry,
                    const TouchSizes& sizes)
        : system_(functions.system()), model_(system_.model()), touch_(touch), geometry_(geometry), sizes_(sizes),
          inputs_(concatenated(touch.state, touch.parameters)), mode_(functions.mode()), n_(index(touch.state.size())),
          time_(-1 / geometry.acceleration) {
        chain_.gain = Eigen::VectorXd::Zero(n_);
        enter(mode_);
    }

    ContactChain follow() {
        const Transition* first = model_.find_transition(mode_, touch_.event);
        if (!first)
            return fail(fmt::format("nothing happens at event '{}' in mode '{}'", model_.events[touch_.event].name,
                                    model_.modes[mode_].name));
        std::optional<Next> next = Next{touch_.event, 0, true};
        while (next) {
            if (chain_.contacts.size() == most_contacts)
                return fail("contacts follow one another without end, as in chatter or sliding");
            if (!advance(*next) || !contact(next->event))
                return std::move(chain_);
            if (chain_.contacts.size() == 1)
                chain_.restitution = geometry_.rate_gradient.head(n_).dot(gain());
            next = next_event();
            if (!chain_.reason.empty())
                return std::move(chain_);
        }
        if (mode_ != touch_.mode)
            return fail(fmt::format("the contact leads to mode '{}', from which the motion does not come back at once",
                                    model_.modes[mode_].name));
        chain_.time = time_ + 1 / geometry_.acceleration;
        return std::move(chain_);
    }

private:
    struct Next {
        std::size_t event = 0;
        double after = 0; ///< time until the event, per unit of s
        bool at_surface = false;
    };
    ContactChain fail(std::string reason) {
        chain_.reason = std::move(reason);
        return std::move(chain_);
    }
    bool set_reason(std::string reason) {
        chain_.reason = std::move(reason);
        return false;
    }

    /// Returns the change of the states since the touch, per unit of s; chain_.gain is this change without the flow of
    /// the touching mode.
    Eigen::VectorXd gain() const { return chain_.gain + geometry_.field * time_; }

    void enter(std::size_t mode) {
        mode_ = mode;
        const std::vector<double> field = system_.mode(mode).rates(inputs_);
        field_ = Eigen::Map<const Eigen::VectorXd>(field.data(), n_);
        if (mode == touch_.mode) {
            surface_ = geometry_;
            return;
        }
        surface_ = TouchFunctions(system_, mode, touch_.event).at(touch_.state, touch_.parameters);
    }

    bool advance(const Next& next) {
        const double speed = surface_.rate_gradient.head(n_).dot(gain());
        depth_ = next.at_surface ? 0 : depth_ + (speed + 0.5 * surface_.acceleration * next.after) * next.after;
        chain_.gain += (field_ - geometry_.field) * next.after;
        time_ += next.after;
        if (!chain_.contacts.empty() && !next.at_surface)
            chain_.leaves_by_surface = false;
        return true;
    }

    /// Applies the transition at an event: its jump, then the guard that chooses the next mode.
    bool contact(std::size_t event) {
        const Transition* transition = model_.find_transition(mode_, event);
        const auto which = static_cast<std::size_t>(transition - model_.transitions.data());
        if (system_.transition(which).following)
            return set_reason(fmt::format("the law of impact has several cases at event '{}', which are not told apart "
                                          "at zero speed",
                                          model_.events[event].name));
        chain_.contacts.push_back(which);
        const System::CompiledJump& jump = system_.jump(transition->jump);
        if (!jump.identity && !pass(jump, transition->jump))
            return false;
        std::optional<std::size_t> mode;
        if (!choose_mode(which, mode))
            return false;
        chain_.ends = !mode && chain_.contacts.size() == 1;
        if (!mode)
            return set_reason(fmt::format("the motion ends at event '{}'", model_.events[event].name));
        enter(*mode);
        chain_.modes.push_back(*mode);
        return true;
    }

    bool pass(const System::CompiledJump& jump, std::size_t number) {
        const std::vector<double> after = jump.map(inputs_), entries = jump.jacobian(inputs_);
        const std::string& name = model_.jumps[number].name;
        const Eigen::VectorXd before = gain();
        Eigen::VectorXd gained = Eigen::VectorXd::Zero(n_), identity = Eigen::VectorXd::Zero(n_);
        for (const std::size_t i : jump.changed) {
            const Eigen::VectorXd unit = Eigen::VectorXd::Unit(n_, index(i));
            if (!sizes_.is_zero(after[i] - touch_.state[i], unit))
                return set_reason(fmt::format("the jump '{}' is not the identity at zero speed: it changes '{}'", name,
                                              model_.states[i].name));
            gained[index(i)] -= before[index(i)];
            identity[index(i)] = 1;
        }
        Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(n_, n_);
        for (std::size_t k = 0; k < jump.entries.size(); ++k)
            if (index(jump.entries[k].column) < n_)
                rows(index(jump.entries[k].row), index(jump.entries[k].column)) = entries[k];
        if (!rows.allFinite())
            return set_reason(fmt::format("the jump '{}' has no derivative at zero speed", name));
        gained += rows * before;
        // States beside the touch that are on the surface with zero speed must not move.
        if (chain_.contacts.size() == 1 && !is_identity_without_speed(rows - Eigen::MatrixXd(identity.asDiagonal())))
            return set_reason(fmt::format("the jump '{}' is not the identity at zero speed", name));
        const double lift = geometry_.gradient.head(n_).dot(gained);
        if (!sizes_.is_zero_gain(lift, geometry_.gradient))
            return set_reason(fmt::format("the jump '{}' moves states off the surface of event '{}'", name,
                                          model_.events[touch_.event].name));
        if (!sizes_.is_zero_gain(gained))
            chain_.only_changes_modes = false;
        chain_.gain += gained;
        return true;
    }

    /// True when states beside the touch do not change that are on the surface with zero speed and, where the touching
    /// mode slides, on the surfaces along which it does. @param change derivatives of a jump minus the identity
    bool is_identity_without_speed(const Eigen::MatrixXd& change) const {
        constexpr double small = 1e-6, independent = 1e-9;
        const Eigen::VectorXd& scales = sizes_.scales();
        const Eigen::MatrixXd scaled = scales.cwiseInverse().asDiagonal() * change * scales.asDiagonal();
        std::vector<Eigen::VectorXd> normals{geometry_.gradient.head(n_), geometry_.rate_gradient.head(n_)};
        for (const SlidingSurface& along : model_.modes[touch_.mode].slides_on) {
            const std::vector<double> values = system_.event(along.surface)(inputs_);
            normals.emplace_back(Eigen::Map<const Eigen::VectorXd>(values.data() + 1, n_));
        }
        Eigen::MatrixXd rest = scaled;
        for (std::size_t i = 0; i < normals.size(); ++i) {
            normals[i] = normals[i].cwiseProduct(scales).normalized();
            for (std::size_t j = 0; j < i; ++j)
                normals[i] -= normals[j].dot(normals[i]) * normals[j];
            const double left = normals[i].norm();
            normals[i] *= left > independent ? 1 / left : 0;
            rest -= scaled * normals[i] * normals[i].transpose();
        }
        return rest.norm() <= small * (1 + scaled.norm());
    }

    /// Chooses the next mode by the signs of the guard conditions near the touch. @return false, with the reason set,
    /// where no alternative holds
    bool choose_mode(std::size_t transition, std::optional<std::size_t>& mode) {
        const Eigen::VectorXd gained = gain();
        for (const Alternative& alternative : model_.transitions[transition].next) {
            bool holds = true;
            for (const Condition& condition : alternative.when) {
                const std::vector<double> values = system_.with_gradient(condition.function)(inputs_);
                const Eigen::Map<const Eigen::VectorXd> gradient(values.data() + 1, index(values.size() - 1));
                double value = values[0];
                if (sizes_.is_zero(value, gradient)) {
                    value = gradient.head(n_).dot(gained);
                    // A value that is zero to first order is taken as zero, such as a speed after an impact without
                    // restitution.
                    if (sizes_.is_zero_gain(value, gradient))
                        value = 0;
                }
                holds = holds && (condition.strict ? value > 0 : value >= 0);
            }
            if (holds) {
                mode = alternative.mode;
                return true;
            }
        }
        return set_reason(fmt::format("no alternative of the guard at event '{}' holds after a contact of small speed",
                                      model_.events[model_.transitions[transition].event].name));
    }

    std::optional<Next> next_event() {
        Next first{0, never, false};
        const System::CompiledMode& mode = system_.mode(mode_);
        for (std::size_t w = 0; w < mode.watched.size(); ++w) {
            if (is_identity_transition(system_, mode.transitions[w]))
                continue;
            const std::size_t event = mode.watched[w];
            const std::vector<double> values = system_.event(event)(inputs_);
            const Eigen::VectorXd gradient = Eigen::Map<const Eigen::VectorXd>(values.data() + 1, n_);
            if (!sizes_.is_zero(values[0], gradient))
                continue;
            const double rate = gradient.dot(field_);
            Next next{event, never, false};
            if (const double side = side_of_surface(event, gradient); side != 0) {
                next.at_surface = true;
                next.after = time_to_surface(event, side, gradient, rate);
            } else {
                next.after = time_to(event, gradient, rate);
            }
            if (!chain_.reason.empty())
                return std::nullopt;
            if (next.after < first.after)
                first = next;
        }
        return first.after < never ? std::optional(first) : std::nullopt;
    }

    /// Returns 1 or -1 if an event function is the touched one up to a positive or negative factor, otherwise 0.
    double side_of_surface(std::size_t event, const Eigen::VectorXd& gradient) const {
        if (event == touch_.event)
            return 1;
        constexpr double small = 1e-9;
        const Eigen::VectorXd own = geometry_.gradient.head(n_).cwiseProduct(sizes_.scales()),
                              other = gradient.cwiseProduct(sizes_.scales());
        const double factor = own.dot(other) / own.squaredNorm();
        if (!((other - factor * own).norm() <= small * other.norm()))
            return 0;
        // The surfaces must agree also away from the touch, not only have the same tangent: test several states nearby.
        constexpr int probes = 4;
        constexpr double far = 0.01;
        for (int probe = 0; probe < probes; ++probe) {
            std::vector<double> state = inputs_;
            for (Eigen::Index i = 0; i < n_; ++i)
                state[static_cast<std::size_t>(i)] +=
                    far * sizes_.scales()[i] *
                    std::cos(1.0 + 2.4 * static_cast<double>(probe) + 1.7 * static_cast<double>(i));
            const double here = system_.event(touch_.event)(state)[0], there = system_.event(event)(state)[0];
            if (!(std::abs(there - factor * here) <= small * std::abs(factor) * own.lpNorm<1>()))
                return 0;
        }
        return factor > 0 ? 1 : -1;
    }

    /// @return time per unit of s, nonnegative
    double time_to_surface(std::size_t event, double side, const Eigen::VectorXd& gradient, double rate) {
        const double acceleration = surface_.acceleration;
        if (!sizes_.is_zero_rate(rate, gradient, field_)) {
            // The vector field crosses the surface: the motion leaves it, or is pressed against it.
            if (rate < 0)
                set_reason(fmt::format("in mode '{}' the motion is pressed against the surface of event '{}'",
                                       model_.modes[mode_].name, model_.events[event].name));
            return never;
        }
        const double speed = surface_.rate_gradient.head(n_).dot(gain());
        const double depth = side * depth_, fall = side * speed, bend = side * acceleration;
        if (std::abs(depth * acceleration) <= small_depth) {
            if (std::abs(fall) <= small_speed) {
                if (!(bend > 0))
                    set_reason(fmt::format("the motion stays on the surface of event '{}', as in sliding or sticking",
                                           model_.events[event].name));
                return never;
            }
            if (fall < 0)
                return set_reason(fmt::format("event '{}' happens again at once", model_.events[event].name)), never;
            return bend < 0 ? -2 * fall / bend : never;
        }
        const double root = fall * fall - 2 * bend * depth;
        if (!(root > 0))
            return never;
        const double after = (-fall - std::sqrt(root)) / bend; // the root at which the function falls
        return after > 0 ? after : never;
    }

    double time_to(std::size_t event, const Eigen::VectorXd& gradient, double rate) {
        const double value = gradient.dot(gain());
        const bool on_surface = sizes_.is_zero_gain(value, gradient);
        if (sizes_.is_zero_rate(rate, gradient, field_)) {
            if (chain_.contacts.size() == 1 && is_slid_along(event))
                chain_.slid_along = event;
            set_reason(fmt::format("event '{}' is touched as well", model_.events[event].name));
            return never;
        }
        if (rate > 0)
            return never;
        if (on_surface || value < 0) {
            set_reason(fmt::format("event '{}' happens at the same time", model_.events[event].name));
            return never;
        }
        return -value / rate;
    }

    /// True when the touching mode keeps the function of an event at zero.
    bool is_slid_along(std::size_t event) const {
        constexpr double small = 1e-9;
        const TouchGeometry here = TouchFunctions(system_, touch_.mode, event).at(touch_.state, touch_.parameters);
        const Eigen::VectorXd &units = sizes_.scales(), own = here.gradient.head(n_).cwiseProduct(units),
                              rates = here.rate_gradient.head(n_).cwiseProduct(units) * sizes_.time();
        const Eigen::VectorXd beside = rates - own * (own.dot(rates) / own.squaredNorm());
        return beside.norm() <= small * own.norm() &&
               std::abs(here.acceleration) * sizes_.time() * sizes_.time() <= small * own.norm();
    }

    static constexpr double small_depth = 1e-12, small_speed = 1e-9; // relative to 1: speeds are in units of s

    const System& system_;
    const Model& model_;
    const TouchState& touch_;
    const TouchGeometry& geometry_;
    const TouchSizes& sizes_;
    std::vector<double> inputs_;
    std::size_t mode_;
    Eigen::Index n_;
    double time_;      ///< time since the touch, per unit of s
    double depth_ = 0; ///< value of the touched function, per unit of s^2
    Eigen::VectorXd field_;
    TouchGeometry surface_; ///< touched function along the current mode
    ContactChain chain_;
};

} // namespace

ContactChain follow_contact(const TouchFunctions& functions, const TouchState& touch, const TouchGeometry& geometry,
                            const TouchSizes& sizes) {
    return ContactFollower(functions, touch, geometry, sizes).follow();
}

} // namespace graze
