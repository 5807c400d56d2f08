// Results of a search.

#include "sweep/attractor_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

namespace graze {

namespace {

/// Returns the labels of transitions, without those that change nothing; repetitions are written as powers.
std::string signature_of(const Model& model, std::span<const std::uint32_t> contacts) {
    std::vector<std::pair<std::string, std::size_t>> parts;
    for (const std::uint32_t code : contacts) {
        const Transition& transition = model.transitions[code / 2];
        const bool stays = std::all_of(transition.next.begin(), transition.next.end(), [&](const Alternative& next) {
            return next.mode && *next.mode == transition.mode;
        });
        const bool sticking = code % 2 == 1;
        if (transition.jump == 0 && stays && !sticking)
            continue;
        std::string name = transition.label + (sticking ? "(chatter)" : "");
        if (!parts.empty() && parts.back().first == name)
            ++parts.back().second;
        else
            parts.emplace_back(std::move(name), 1);
    }
    std::string text;
    for (const auto& [name, count] : parts)
        text += fmt::format("{}{}{}", text.empty() ? "" : " ", name, count > 1 ? fmt::format("^{}", count) : "");
    return text;
}

} // namespace

bool AttractorSearch::finish_periodic() {
    finish(Label::periodic);
    result_.period = finder_.period();
    result_.duration = finder_.duration();
    result_.signature = signature_of(setting_->simulation.model(), finder_.contacts());
    result_.symmetric = finder_.symmetric();
    result_.multipliers = finder_.multipliers();
    result_.residual = finder_.residual();
    result_.state.assign(finder_.point().begin(), finder_.point().end());
    keep_signs(result_.state);
    result_.mode = finder_.mode();
    result_.samples = std::move(finder_.samples());
    result_.lyapunov.reset();
    result_.lyapunov_error.reset();
    if (chaotic_ > 0)
        result_.outcome.detail = fmt::format("after a chaotic transient of up to {} returns", result_.cycles);
    if (repeating_)
        result_.outcome.detail = "repeats itself, as neighbours may in their own ways: a multiplier is 1";
    if (!result_.multipliers.empty() && std::abs(result_.multipliers.front()) > 0)
        result_.lyapunov = std::log(std::abs(result_.multipliers.front())) / result_.duration;
    return false;
}

bool AttractorSearch::finish_equilibrium(const Equilibrium& equilibrium) {
    finish(Label::equilibrium);
    result_.state = equilibrium.state;
    result_.mode = equilibrium.mode;
    result_.lyapunov.reset();
    result_.lyapunov_error.reset();
    if (!equilibrium.driven && equilibrium.values.size() > 0)
        result_.lyapunov = equilibrium.growth();
    if (setting_->map.is_phase() && watcher_.remembered() > 1) {
        // Returns continue as those of an orbit of period 1.
        result_.period = 1;
        result_.duration = watcher_.recent(0).time - watcher_.recent(1).time;
        if (equilibrium.driven) {
            result_.multipliers = finder_.multipliers();
            if (!result_.multipliers.empty() && std::abs(result_.multipliers.front()) > 0)
                result_.lyapunov = std::log(std::abs(result_.multipliers.front())) / finder_.duration();
        }
        for (const std::complex<double> value : equilibrium.values)
            if (!equilibrium.driven)
                result_.multipliers.push_back(std::exp(value * result_.duration));
    }
    recorder_.rest(main_->time(), result_.state);
    keep_signs(result_.state);
    result_.samples = std::move(recorder_.samples());
    return false;
}

bool AttractorSearch::finish(Label label) {
    result_.label = label;
    result_.cycles = watcher_.returns();
    result_.periods_run += watcher_.returns();
    result_.time = main_->time();
    result_.state.assign(main_->state().begin(), main_->state().end());
    result_.mode = main_->mode();
    result_.outcome = main_->outcome();
    if (label == Label::unbounded)
        result_.outcome.detail.clear(); // the overflow is no fault of the model
    if (watcher_.stuck())
        result_.outcome.detail = "no return to the section came; choose another section";
    if (label != Label::periodic && label != Label::equilibrium)
        exponent_.catch_up();
    if (collapses_repeatedly()) {
        // The exponent would be minus infinity.
        if (label == Label::unsettled && result_.outcome.detail.empty())
            result_.outcome.detail = fmt::format("neighbouring motions have merged at {} accumulations of contacts: "
                                                 "this is not chaos, but a long period or a long transient",
                                                 collapses_);
    } else if (exponent_.known()) {
        result_.lyapunov = exponent_.value();
        result_.lyapunov_error = exponent_.error();
    }
    recorder_.keep_last(setting_->options.keep);
    result_.samples = std::move(recorder_.samples());
    return false;
}

} // namespace graze
