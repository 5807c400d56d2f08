#include "page/point_actions.hpp"

#include "base/concatenated.hpp"
#include "graze/base/rounded.hpp"
#include "graze/branch/monitor.hpp"
#include "graze/orbit/signature.hpp"
#include "graze/symbolic/transform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

constexpr int proposed_digits = 3; ///< of bounds

/// The parameters on which the rates of cyclic states depend: above all the frequency of a force, along which
/// resonances lie, and which most authors follow first.
std::vector<std::string> frequencies(const Model& model) {
    Model expanding = model;
    std::vector<Expression> rates;
    for (const Mode& mode : model.modes)
        for (std::size_t i = 0; i < model.states.size(); ++i)
            if (model.states[i].period)
                rates.push_back(expanding.expand(mode.rates[i]));
    std::vector<std::string> names;
    for (const Expression& symbol : symbols_of(rates))
        if (model.find_independent_parameter(symbol.name()))
            names.push_back(symbol.name());
    return names;
}

/// Whether the initial mode may have equilibria: nothing in it depends on a state that moves whatever the states are,
/// such as the phase of a force.
bool may_rest(const Model& model) {
    Model expanding = model;
    const std::vector<Expression> states = expanding.state_symbols(),
                                  rates = expanding.expand(model.modes[model.initial_mode].rates),
                                  met = symbols_of(rates);
    for (std::size_t i = 0; i < states.size(); ++i) {
        const std::vector<Expression> in_rate = symbols_of(std::span(&rates[i], 1));
        const bool is_clock = !rates[i].is_number(0) && std::ranges::none_of(in_rate, [&](const Expression& one) {
            return std::ranges::find(states, one) != states.end();
        });
        if (is_clock &&
            (std::ranges::find(met, states[i]) != met.end() || (!model.states[i].period && !model.states[i].drifting)))
            return false;
    }
    return true;
}

/// Collects the actions of one point.
class ActionFinder {
public:
    explicit ActionFinder(const PointOrigin& origin)
        : origin_(origin), type_(origin.type()), parameters_(proposed_parameters(origin)),
          has_section_(!origin.model.sections.empty()),
          rests_(origin.orbit && is_rest(origin.orbit->point.solution.orbit.signature)) {}

    std::vector<PointAction> find() {
        if (origin_.run.empty())
            find_of_model();
        else if (origin_.orbit)
            find_of_orbit();
        else if (origin_.point)
            find_of_motion();
        return std::move(actions_);
    }

private:
    void add(std::string name, std::string title, std::string words, std::size_t along = 0, std::string onto = "") {
        if (along > parameters_.size())
            return;
        actions_.push_back({std::move(name),
                            std::move(title),
                            std::move(words),
                            {parameters_.begin(), parameters_.begin() + static_cast<std::ptrdiff_t>(along)},
                            std::move(onto)});
    }
    /// The same along another parameter than that of the run.
    void add_another(std::string words) {
        if (parameters_.size() < 2)
            return;
        add("another", "Another parameter", std::move(words), 1, "same");
        actions_.back().along = {parameters_[1]};
    }

    bool has_own_parameter() const { return origin_.is_of(RunKind::follow) || origin_.is_of(RunKind::ladder); }

    double value_of_parameter(const std::string& name) const {
        return origin_.model.parameter_values()[origin_.model.independent_parameter(name).place()];
    }

    void find_of_model() {
        add("simulate", "Simulate", "the motion from the initial state");
        if (may_rest(origin_.model))
            add("equilibrium", "Find the equilibrium", "the one to which Newton's method leads from the initial state");
        if (!has_section_)
            return;
        add("sweep", "Sweep", "what motions settle on as a parameter changes", 1);
        add("orbit", "Find the orbit", "the periodic orbit that the motion from the initial state settles on");
    }

    void find_of_motion() {
        const PointResult& result = origin_.point->result;
        const bool goes_on = std::ranges::all_of(result.state, [](double x) { return std::isfinite(x); }) &&
                             result.label != Label::singular && result.label != Label::failed;
        if (!goes_on)
            return;
        if (result.label == Label::periodic && has_section_) {
            add("orbit", "Find the orbit", "the periodic orbit that the motion has settled on, with its multipliers");
            add("follow", "Follow the orbit", "its branch as a parameter changes, also where it is unstable", 1);
        }
        if (result.label == Label::equilibrium)
            add("equilibrium", "Find the equilibrium", "the one in which the motion ends, with its eigenvalues");
        find_of_any();
    }

    /// From wherever a motion can begin.
    void find_of_any() {
        if (has_section_ && !parameters_.empty()) {
            add("sweep", "Sweep from here", "what the motion settles on as a parameter changes step by step", 1);
            AlongParameter& swept = actions_.back().along.front();
            const double here = value_of_parameter(swept.name);
            swept.least = here;
            if (!(swept.greatest > here))
                swept.greatest = rounded(here + std::max(std::abs(here), 0.01), proposed_digits);
        }
        add("simulate", "Simulate from here", "the motion that begins here");
    }

    void find_of_orbit() {
        if (origin_.orbit->point.solution.outcome != OrbitOutcome::converged)
            return;
        if (origin_.is_of(RunKind::curve))
            find_of_curve();
        else if (type_ == PointType::locking)
            find_of_locking();
        else if (!origin_.is_of(RunKind::torus))
            find_of_branch();
        find_of_any();
    }

    void find_of_locking() {
        add("curve", "Edge of the tongue", "where the motion begins or ceases to lock as two parameters change", 2);
        add("follow", "The locked orbits", "the stable and the unstable orbit that meet here", 1);
    }

    void find_of_branch() {
        const PointKind& kind = kind_of(type_);
        if (origin_.orbit->point.solution.orbit.cycle) {
            find_of_homoclinic(kind);
            return;
        }
        if (type_ == PointType::hopf && rests_)
            add("switch", "The cycles", "the cycles that begin at this Hopf point", 1, "other");
        else if (type_ == PointType::hopf)
            add("switch", "The equilibria", "the branch of equilibria at which the cycles end", 1, "other");
        else if (type_ == PointType::flip)
            add("double", "Double the period", "the orbits of twice the period that leave at this flip", 1, "other");
        else if (type_ == PointType::grazing)
            add("switch", "Beyond the grazing", "the orbits with one contact more, or fewer", 1, "other");
        else if (type_ == PointType::asymmetry)
            add("switch", "Lose the symmetry", "the orbits without the symmetry, which leave here", 1, "other");
        else if (kind.has_bifurcating_branch)
            add("switch", "The other branch", "the branch that crosses here", 1, "other");
        // A Hopf point is held on equilibria only, on which branch points are not.
        if (kind.may_be_kept && (type_ == PointType::hopf ? rests_ : !rests_ || type_ != PointType::branch_point))
            add("curve", "Curve of such points", fmt::format("where this {} is as two parameters change", kind.name),
                2);
        if (type_ == PointType::chatter)
            add("curve", "Curve of such points", "where this onset of chatter is as two parameters change", 2);
        if (type_ == PointType::grazing)
            add("ladder", "Ladder of grazings", "the next grazings, each with one contact more, up to chatter", 1);
        const char* const what = rests_ ? "equilibrium" : "orbit";
        if (type_ == PointType::homoclinic) // it exists at one value of a parameter only
            return;
        add("follow", "Follow",
            has_own_parameter() ? "the same branch along this parameter, with other bounds if wanted"
                                : fmt::format("follow this {} as a parameter changes", what),
            1, has_own_parameter() ? "same" : "");
        if (has_own_parameter())
            add_another(fmt::format("the branch of this {} along another parameter", what));
        const Orbit& orbit = origin_.orbit->point.solution.orbit;
        // The image of an orbit that ends at a section does not end there.
        if (!origin_.model.symmetries.empty() && !orbit.symmetry && !orbit.signature.empty() &&
            ends_by_transition(orbit.signature.back()))
            add("twin", "Symmetric image", "the branch of the symmetric image of this orbit", 1, "twin");
    }

    /// Of an orbit that is homoclinic to a cycle: no other branch leaves it.
    void find_of_homoclinic(const PointKind& kind) {
        if (kind.may_be_kept)
            add("curve", "Curve of such points", fmt::format("where this {} is as two parameters change", kind.name),
                2);
        add("follow", "Follow", "the same branch along this parameter, with other bounds if wanted", 1, "same");
        add_another("the branch of this orbit along another parameter");
    }

    /// Curves that meet here, of points of other types.
    void find_of_curve() {
        if (is_homoclinic(origin_.orbit->point.solution.orbit.signature))
            return;
        const auto curve = [&](const char* of, const char* words) {
            add(fmt::format("curve-{}", of), fmt::format("Curve of {}", words),
                fmt::format("the curve of {} that meets this one here", words), 2, of);
        };
        const bool folds = type_ == PointType::fold_flip || type_ == PointType::fold_torus ||
                           type_ == PointType::fold_degenerate || type_ == PointType::resonance_1 ||
                           type_ == PointType::takens_bogdanov || type_ == PointType::zero_hopf;
        const bool flips = type_ == PointType::fold_flip || type_ == PointType::flip_torus ||
                           type_ == PointType::flip_degenerate || type_ == PointType::resonance_2;
        const bool tori = type_ == PointType::fold_torus || type_ == PointType::flip_torus ||
                          type_ == PointType::resonance_1 || type_ == PointType::resonance_2;
        const bool hopf =
            type_ == PointType::takens_bogdanov || type_ == PointType::zero_hopf || type_ == PointType::double_hopf;
        if (folds)
            curve("SN", "folds");
        if (flips)
            curve("PD", "flips");
        if (tori)
            curve("NS", "torus points");
        if (hopf)
            curve("HB", "Hopf points");
        const char* const what = rests_ ? "equilibrium" : "orbit";
        add("follow", "Follow one parameter", fmt::format("the branch of this {} as one parameter changes", what), 1,
            "same");
        add_another(fmt::format("the branch of this {} along the other parameter", what));
    }

    const PointOrigin& origin_;
    PointType type_;
    std::vector<AlongParameter> parameters_;
    bool has_section_;
    bool rests_; ///< the point is an equilibrium
    std::vector<PointAction> actions_;
};

/// Adds the coordinates of the family of an orbit: first that along which it was followed.
void add_families(const PointOrigin& origin, std::vector<AlongParameter>& result) {
    if (!origin.orbit)
        return;
    const Orbit& orbit = origin.orbit->point.solution.orbit;
    if (orbit.segments() == 0 || is_rest(orbit.signature))
        return;
    const bool follows = origin.asked.is_followed();
    const BranchSettings settings = follows ? origin.asked.branch().settings : BranchSettings();
    const auto add = [&](const std::string& name, double value) {
        const bool followed = settings.family && settings.family->name() == name;
        const double reach = value != 0 ? 0.5 * std::abs(value) : 1;
        const AlongParameter one{
            name, followed && settings.least ? *settings.least : rounded(value - reach, proposed_digits),
            followed && settings.greatest ? *settings.greatest : rounded(value + 2 * reach, proposed_digits)};
        result.insert(followed ? result.begin() : result.end(), one);
    };
    for (const ConservedQuantity& conserved : origin.model.conserved) {
        const Expression value =
            monitor_of_conserved(origin.model, conserved.name).expression_in(orbit.signature[0].mode);
        add(conserved.name, origin.model.function_of({&value, 1})(concatenated(orbit.starts[0], orbit.parameters))[0]);
    }
    if (settings.family && settings.family->conserved.empty())
        add(settings.family->name(), orbit.period());
}

} // namespace

std::vector<AlongParameter> proposed_parameters(const PointOrigin& origin) {
    std::vector<AlongParameter> result;
    const std::vector<std::string> names = origin.model.independent_parameters();
    const std::vector<double> values = origin.model.parameter_values();
    const auto add = [&](std::size_t p, std::optional<double> least, std::optional<double> greatest) {
        if (p >= names.size() || std::ranges::find(result, names[p], &AlongParameter::name) != result.end())
            return;
        const double value = values[p], reach = value != 0 ? std::abs(value) : 1;
        // A parameter seldom changes its sign.
        const double low = rounded(value > 0 ? value / 2 : value - reach, proposed_digits),
                     high = rounded(value < 0 ? value / 2 : value + reach, proposed_digits);
        result.push_back({names[p], least.value_or(low), greatest.value_or(high)});
    };
    if (origin.run.empty() || origin.asked.is_measured()) {
        // nothing is followed or varied
    } else if (origin.asked.is_followed()) {
        const BranchSettings& settings = origin.asked.branch().settings;
        if (!settings.family)
            add(settings.parameter.place(), settings.least, settings.greatest);
        for (const FreeBounds& other : settings.free_bounds)
            add(other.parameter.place(), other.least, other.greatest);
        for (const ParameterId other : settings.free)
            add(other.place(), {}, {});
    } else if (origin.asked.has_motions()) {
        for (const Variation& axis : origin.asked.motion().axes)
            if (!axis.state && axis.values.size() > 1)
                add(axis.parameter.place(), axis.values.front(), axis.values.back());
    }
    for (const std::string& name : frequencies(origin.model))
        add(origin.model.independent_parameter(name).place(), {}, {});
    for (std::size_t p = 0; p < names.size(); ++p)
        add(p, {}, {});
    add_families(origin, result);
    return result;
}

std::vector<PointAction> actions_at(const PointOrigin& origin) {
    return ActionFinder(origin).find();
}

nlohmann::json actions_json(const std::vector<PointAction>& actions) {
    nlohmann::json list = nlohmann::json::array();
    for (const PointAction& action : actions) {
        list.push_back(
            {{"name", action.name}, {"title", action.title}, {"words", action.words}, {"along", action.along.size()}});
        nlohmann::json parameters = nlohmann::json::array();
        for (const AlongParameter& one : action.along)
            parameters.push_back({{"name", one.name}, {"least", one.least}, {"greatest", one.greatest}});
        list.back()["parameters"] = std::move(parameters);
    }
    return list;
}

} // namespace graze
