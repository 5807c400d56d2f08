#pragma once

#include "graze/trajectory/observer.hpp"

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace graze {

/// Limits of one leg of a run; the leg ends at whichever is reached first.
struct LegEnd {
    double duration = std::numeric_limits<double>::infinity();
    std::size_t periods = 0;  ///< 0: not counted
    std::size_t contacts = 0; ///< 0: not counted
    /// Duration of the leg, if known beforehand; for progress reports.
    std::optional<double> expected;

    bool empty() const { return duration == std::numeric_limits<double>::infinity() && periods == 0 && contacts == 0; }
};

/// Decides when a leg of a run is over, and forwards the legs that are to be shown to recorders.
class RunControl : public Observer {
public:
    /// @param recorders are shared; null: none. @param period_probe index of the probe whose passages are periods
    /// @param counted for each event, whether its contacts are counted
    RunControl(std::shared_ptr<Observer> recorders, std::optional<std::size_t> period_probe, std::vector<bool> counted);

    void begin(const LegEnd& end, double time, bool shown);
    /// Sets a condition that ends the run in any case; called after each step.
    void end_when(std::function<bool()> ends) { ends_ = std::move(ends); }
    /// Sets a function that receives, after each step, the completed fraction of the leg (if known) and the time.
    void tell(std::function<void(std::optional<double> fraction, double time)> progress) {
        progress_ = std::move(progress);
    }

    void step(const Step& step) override;
    void contact(const Contact& contact) override;
    void passage(const Passage& passage) override;
    void minimum(const StepMinimum& minimum) override;
    bool stop() override;

private:
    bool is_reached() const;

    std::shared_ptr<Observer> recorders_;
    std::optional<std::size_t> period_probe_;
    std::vector<bool> counted_;
    std::function<bool()> ends_;
    std::function<void(std::optional<double>, double)> progress_;
    LegEnd end_;
    double start_ = 0, time_ = 0;
    std::size_t periods_ = 0, contacts_ = 0;
    bool shown_ = false;
};

} // namespace graze
