#include "graze/model/microbeam.hpp"

#include "base/read_whole.hpp"
#include "graze/base/input_error.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/microbeam_drawing.hpp"
#include "model/microbeam_quadrature.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace graze {
namespace {

void require(bool holds, const std::string& problem, const std::string& remedy) {
    if (!holds)
        throw InputError("microbeam: " + problem, remedy);
}

void require_sensible(const MicrobeamOptions& o) {
    const std::pair<const char*, double> numbers[] = {
        {"gamma", o.gamma},
        {"thickness", o.thickness},
        {"width", o.width},
        {"gap", o.gap},
        {"stop position", o.stop_position},
        {"stop distance", o.stop_distance},
        {"stop stiffness", o.stop_stiffness},
        {"frequency", o.frequency},
        {"voltage", o.voltage},
        {"damping", o.damping},
    };
    for (const auto& [name, value] : numbers)
        require(std::isfinite(value), std::string("the ") + name + " is not finite", "give a finite number");
    constexpr int most_modes = 200;
    require(o.modes >= 1 && o.modes <= most_modes, "the number of modes is " + std::to_string(o.modes),
            "give a number between 1 and " + std::to_string(most_modes));
    require(o.modes == 1 || o.trial == TrialFunctions::eigenmodes, "there is one polynomial only",
            "ask for one mode, or for eigenmodes");
    require(o.thickness > 0 && o.width > 0, "thickness and width must be positive", "give the shape of a beam");
    require(o.gap > 0, "the gap must be positive", "give the distance of the electrode from the undeformed beam");
    require(o.gamma >= 0 && o.damping >= 0 && o.stop_stiffness >= 0,
            "gamma, damping and stop stiffness must not be negative", "give zero to leave an effect out");
    require(o.frequency > 0, "the frequency must be positive", "give the angular frequency of the pulse train");
    require(o.stop_position > 0 && o.stop_position < 1, "the stop must be between the clamps",
            "give a position between 0 and 1, in units of the beam's length");
    require(o.stop_distance != 0 && o.stop_distance < o.gap,
            "the stop must be on one side of the undeformed beam and short of the electrode",
            "give a distance that is not 0 and less than the gap");
}

/// Builds the model; each function adds one part.
///
/// Operands of sums and products are printed in the order of their creation, and compilers choose the order in which
/// they evaluate operands. For a reproducible text, every symbol is created at its declaration, and compound terms
/// before they are added.
class MicrobeamBuilder {
public:
    explicit MicrobeamBuilder(const MicrobeamOptions& options)
        : options_(options), beam_(options.modes), pairs_(node_pairs(options.quadrature, options.points)) {}

    Model build() {
        add_documentation();
        add_parameters();
        add_states();
        add_stretching();
        add_electrostatics();
        add_stop();
        if (options_.steady) {
            add_steady_motion();
        } else {
            add_events_and_jumps();
            add_modes();
            add_transitions();
        }
        add_sections_and_quantities();
        model_.drawing = microbeam_drawing(options_, [&](int i, double x) { return shape(i, x); });
        model_.validate();
        return std::move(model_);
    }

private:
    enum ModeIndex : std::size_t { free_on, free_off, contact_on, contact_off };
    enum EventIndex : std::size_t { touch, leave, pulse_end, pulse_start, closure };
    enum JumpIndex : std::size_t { identity, switch_off, switch_on };

    static std::string numbered(const std::string& stem, int i) { return stem + std::to_string(i); }
    int count() const { return beam_.count(); }
    bool polynomial() const { return options_.trial == TrialFunctions::polynomial; }
    double frequency_of(int i) const { return polynomial() ? polynomial_.frequency() : beam_.frequency(i); }
    double shape(int i, double x) const { return polynomial() ? polynomial_.shape(x) : beam_.shape(i, x); }
    double slope_product(int i, int j) const {
        return polynomial() ? polynomial_.slope_product() : beam_.slope_product(i, j);
    }
    Expression symbol(std::string_view name) const { return model_.symbol(name); }
    Expression q(int i) const { return symbol(numbered("q", i)); }
    Expression v(int i) const { return symbol(numbered("v", i)); }
    Expression number(double value) const { return model_.graph->number(value); }

    Expression define(const std::string& name, const std::string& text, const Expression& value) {
        model_.definitions.push_back({name, text, value});
        return symbol(name);
    }

    /// Returns the sum; terms that vanish identically are left out.
    static Expression added(const Expression& sum, const Expression& term) {
        if (term.is_number(0))
            return sum;
        return sum.empty() || sum.is_number(0) ? term : sum + term;
    }

    void add_documentation() {
        const bool simpson = options_.quadrature == Quadrature::simpson;
        const std::string rule = simpson ? "Simpson's rule with " + std::to_string(options_.points) + " intervals"
                                         : "Gauss's rule with " + std::to_string(options_.points) + " nodes";
        model_.name = polynomial()  ? "microbeam-polynomial"
                      : count() > 1 ? numbered("microbeam-", count())
                                    : std::string(options_.steady ? "microbeam-steady" : "microbeam");
        const std::string functions = polynomial() ? "the polynomial x^2 (x - 1)^2"
                                      : count() == 1
                                          ? "the first eigenmode of the linear beam"
                                          : "the first " + std::to_string(count()) + " eigenmodes of the linear beam";
        model_.text = std::string("A doubly clamped microbeam is pulled by ") +
                      (options_.steady ? "a steady voltage" : "electrostatic pulses") +
                      " against a compliant stop. Its deflection is projected onto " + functions +
                      ", and the electrostatic force is integrated by " + rule +
                      ". Nondimensional: lengths in units of the beam's length l, time in units of "
                      "sqrt(rho b h l^4/(E I)). Closure of the gap to the electrode (snap-through) ends the motion: " +
                      (options_.steady ? "it is singular."
                                       : "while the voltage is on it is singular, and while it is off an event.");
        model_.source = "B. E. Wilcox, On the use of impact-induced nonlinearities in limit switch design, chapter 3: "
                        "Eqs. (3.7)-(3.17), (3.22), (3.23) and (3.30); section 3.4 for the parameters. The damping "
                        "factor is not given there: 0.05 agrees with what is.";
    }

    void add_parameter(const std::string& name, double value, const std::string& text) {
        model_.parameters.push_back({name, "", text, value, std::nullopt});
        symbol(name);
    }

    void add_parameters() {
        add_parameter("V", options_.voltage, "amplitude of the voltage pulses");
        add_parameter("omega", options_.frequency, "angular frequency of the pulse train");
        add_parameter("zeta", options_.damping, "damping factor of every mode");
        add_parameter("gamma", options_.gamma, "stiffening by stretching of the mid-line, b h l^2/I");
        add_parameter("h", options_.thickness, "thickness of the beam");
        add_parameter("b", options_.width, "width of the beam");
        add_parameter("g0", options_.gap, "distance between the electrode and the undeformed beam");
        add_parameter("k", options_.stop_stiffness, "stiffness of the stop");
        add_parameter("d", options_.stop_distance,
                      std::string("distance from the undeformed beam to the stop towards the electrode; must remain ") +
                          (options_.stop_distance > 0 ? "positive" : "negative"));
        model_.parameters.push_back({"fringe", "", "strength of the fringe field, Eq. (3.12)", std::nullopt,
                                     0.204 + 0.6 * pow(symbol("h") / symbol("b"), 0.24)});
        symbol("fringe");
    }

    void add_states() {
        const Expression zero = number(0);
        for (int i = 1; i <= count(); ++i)
            model_.states.push_back({numbered("q", i), "", numbered("amplitude of mode ", i), zero, {}, false});
        for (int i = 1; i <= count(); ++i)
            model_.states.push_back({numbered("v", i), "", numbered("velocity of mode ", i), zero, {}, false});
        model_.states.push_back({"theta", "", "phase of the pulse train", zero, number(2 * std::numbers::pi), false});
        model_.state_symbols();
    }

    void add_stretching() {
        for (int i = 1; i <= count(); ++i)
            define(numbered("frequency_", i), numbered("modal frequency ", i), number(frequency_of(i)));
        Expression stretch = number(0);
        for (int i = 1; i <= count(); ++i) {
            Expression slope = number(0);
            for (int j = 1; j <= count(); ++j)
                slope = added(slope, slope_product(i, j) * q(j));
            define(numbered("slope_", i), numbered("slope of the beam projected onto that of mode ", i), slope);
            stretch = added(stretch, symbol(numbered("slope_", i)) * q(i));
        }
        define("stretch", "mean square of the slope, twice the strain of the mid-line", stretch);
    }

    /// Returns the deflection at x due to the symmetric modes (first = 1) or the antisymmetric modes (first = 2).
    Expression partial_deflection(double x, int first) const {
        Expression sum = number(0);
        for (int i = first; i <= count(); i += 2)
            sum = added(sum, shape(i, x) * q(i));
        return sum;
    }

    /// Adds definitions of gap and attraction at the node `label`, where the deflection is given.
    Expression add_pressure(const std::string& label, const Expression& deflection) {
        const Expression gap = define("gap_" + label, "distance between beam and electrode", symbol("g0") - deflection);
        return define("pressure_" + label, "attraction there per V^2, Eqs. (3.11) and (3.12)",
                      (1 + symbol("fringe") * pow(gap / symbol("b"), 0.76)) / pow(gap, 2.0));
    }

    /// Nodes x and 1 - x are treated together: symmetric modes have equal and antisymmetric modes opposite
    /// values, which halves the work.
    void add_electrostatics() {
        std::vector<Expression> pulls(static_cast<std::size_t>(count()), number(0));
        const bool has_antisymmetric = count() > 1;
        for (std::size_t pair = 0; pair < pairs_.size(); ++pair) {
            const NodePair& node = pairs_[pair];
            const std::string label = std::to_string(pair + 1);
            const std::string place = "at x = " + to_string(number(node.x));
            const Expression even =
                define(has_antisymmetric ? "even_" + label : "deflection_" + label,
                       (has_antisymmetric ? "deflection by symmetric modes " : "deflection ") + place,
                       partial_deflection(node.x, 1));
            Expression sum, difference;
            if (node.is_centre()) {
                sum = add_pressure(label, even);
            } else if (!has_antisymmetric) {
                sum = 2 * add_pressure(label, even);
            } else {
                const Expression odd =
                    define("odd_" + label, "deflection by antisymmetric modes " + place, partial_deflection(node.x, 2));
                const Expression here = add_pressure(label, even + odd);
                const Expression mirror = add_pressure(label + "_mirror", even - odd);
                sum = here + mirror;
                difference = here - mirror;
            }
            for (int i = 1; i <= count(); ++i) {
                const Expression& pressures = i % 2 == 1 ? sum : difference;
                if (!pressures.empty()) {
                    Expression& pull = pulls[static_cast<std::size_t>(i - 1)];
                    pull = added(pull, node.weight * shape(i, node.x) * pressures);
                }
            }
        }
        for (int i = 1; i <= count(); ++i)
            define(numbered("pull_", i), numbered("attraction per V^2 projected onto mode ", i),
                   pulls[static_cast<std::size_t>(i - 1)]);
    }

    void add_stop() {
        Expression deflection = number(0), velocity = number(0);
        for (int i = 1; i <= count(); ++i) {
            const double there = shape(i, options_.stop_position);
            deflection = added(deflection, there * q(i));
            velocity = added(velocity, there * v(i));
        }
        const std::string where = "of the beam at the stop, x = " + to_string(number(options_.stop_position));
        const Expression w = define("deflection", "deflection " + where, deflection);
        define("velocity", "velocity " + where, velocity);
        define("clearance", "distance between beam and stop",
               options_.stop_distance > 0 ? symbol("d") - w : w - symbol("d"));
        define("stop_force", "force of the stop on the beam, Eq. (3.22)", symbol("k") * (symbol("d") - w));
    }

    void add_events_and_jumps() {
        const Expression theta = symbol("theta"), clearance = symbol("clearance");
        const double pi = std::numbers::pi;
        model_.events = {
            {"touch", "the beam meets the stop", clearance, EventKind::barrier},
            {"leave", "the beam leaves the stop", -clearance, EventKind::barrier},
            {"pulse_end", "the voltage is switched off", pi - theta, EventKind::barrier},
            {"pulse_start", "the voltage is switched on", 2 * pi - theta, EventKind::barrier},
            {"closure", "the beam meets the electrode at mid-span while the voltage is off",
             symbol("g0") - partial_deflection(0.5, 1), EventKind::barrier},
        };
        const std::vector<Expression> states = model_.state_symbols();
        model_.jumps[identity].map = states;
        model_.jumps.push_back({"switch_off", "the phase is set to pi exactly", states});
        model_.jumps.push_back({"switch_on", "the phase is set to 0 exactly", states});
        model_.jumps[switch_off].map.back() = number(pi);
        model_.jumps[switch_on].map.back() = number(0);
    }

    std::vector<Expression> rates(bool on, bool contact) const {
        std::vector<Expression> rates;
        for (int i = 1; i <= count(); ++i)
            rates.push_back(v(i));
        for (int i = 1; i <= count(); ++i) {
            const Expression frequency = symbol(numbered("frequency_", i));
            const Expression drag = 2 * symbol("zeta") * frequency * v(i);
            const Expression bending = pow(frequency, 2.0) * q(i);
            const Expression stretching = symbol("gamma") / 2 * symbol("stretch") * symbol(numbered("slope_", i));
            Expression rate = -drag - bending - stretching;
            if (on)
                rate = rate + pow(symbol("V"), 2.0) * symbol(numbered("pull_", i));
            if (contact)
                rate = added(rate, shape(i, options_.stop_position) * symbol("stop_force"));
            rates.push_back(rate);
        }
        rates.push_back(symbol("omega"));
        return rates;
    }

    void add_modes() {
        model_.modes = {
            {"free_on", "voltage on, beam clear of the stop", rates(true, false), {pulse_end, touch}},
            {"free_off", "voltage off, beam clear of the stop", rates(false, false), {pulse_start, touch, closure}},
            {"contact_on", "voltage on, beam on the stop", rates(true, true), {pulse_end, leave}},
            {"contact_off", "voltage off, beam on the stop", rates(false, true), {pulse_start, leave, closure}},
        };
        model_.initial_mode = free_on;
    }

    /// Steady voltage: the phase still advances, so that equilibria are orbits with a period.
    void add_steady_motion() {
        constexpr std::size_t free = 0, contact = 1;
        model_.events = {{"touch", "the beam meets the stop", symbol("clearance"), EventKind::barrier},
                         {"leave", "the beam leaves the stop", -symbol("clearance"), EventKind::barrier}};
        model_.jumps[identity].map = model_.state_symbols();
        model_.modes = {{"free", "beam clear of the stop", rates(true, false), {touch}},
                        {"contact", "beam on the stop", rates(true, true), {leave}}};
        model_.initial_mode = free;
        add_transition(free, touch, identity, contact);
        add_transition(contact, leave, identity, free);
    }

    void add_transition(std::size_t mode, EventIndex event, JumpIndex jump, std::optional<std::size_t> next) {
        const std::string label = model_.modes[mode].name + ":" + model_.events[event].name;
        model_.transitions.push_back({label, mode, event, jump, {{{}, "", next}}, {}});
    }

    void add_transitions() {
        add_transition(free_on, pulse_end, switch_off, free_off);
        add_transition(free_on, touch, identity, contact_on);
        add_transition(free_off, pulse_start, switch_on, free_on);
        add_transition(free_off, touch, identity, contact_off);
        add_transition(free_off, closure, identity, std::nullopt);
        add_transition(contact_on, pulse_end, switch_off, contact_off);
        add_transition(contact_on, leave, identity, free_on);
        add_transition(contact_off, pulse_start, switch_on, contact_on);
        add_transition(contact_off, leave, identity, free_off);
        add_transition(contact_off, closure, identity, std::nullopt);
    }

    void add_sections_and_quantities() {
        model_.sections.push_back(
            {"phase0", "the voltage is switched on", {}, model_.find_state("theta"), number(0), Direction::both});
        model_.sections.push_back(
            {"turning", "the beam comes to rest at the stop's place", symbol("velocity"), {}, {}, Direction::both});
        Expression kinetic = number(0), bending = number(0);
        for (int i = 1; i <= count(); ++i) {
            kinetic = added(kinetic, pow(v(i), 2.0) / 2);
            bending = added(bending, pow(symbol(numbered("frequency_", i)) * q(i), 2.0) / 2);
        }
        const Expression stretching = symbol("gamma") * pow(symbol("stretch"), 2.0) / 8;
        model_.quantities = {
            {"midspan", "", "deflection at mid-span", partial_deflection(0.5, 1)},
            {"penetration", "", "depth of the beam in the stop, negative when clear of it", -symbol("clearance")},
            {"contact_velocity", "", "velocity of the beam at the stop's place", symbol("velocity")},
            {"energy", "", "kinetic, bending and stretching energy of the beam", kinetic + bending + stretching},
        };
    }

    MicrobeamOptions options_;
    ClampedBeamModes beam_;
    ClampedBeamPolynomial polynomial_;
    std::vector<NodePair> pairs_;
    Model model_;
};

} // namespace

Model microbeam(const MicrobeamOptions& options) {
    require_sensible(options);
    return MicrobeamBuilder(options).build();
}

std::optional<MicrobeamOptions> microbeam_member(std::string_view model_name) {
    constexpr std::string_view family = "microbeam-";
    if (!model_name.starts_with(family))
        return std::nullopt;
    const std::string_view member = model_name.substr(family.size());
    MicrobeamOptions options;
    if (member == "polynomial") {
        options.trial = TrialFunctions::polynomial;
        return options;
    }
    if (member == "steady") {
        options.steady = true;
        return options;
    }
    // "microbeam-1" is refused: its name is that of the family.
    const bool number = !member.starts_with('0') && read_whole(member, options.modes);
    return number && options.modes > 1 ? std::optional(options) : std::nullopt;
}

} // namespace graze
