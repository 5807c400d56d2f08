#pragma once

#include "graze/trajectory/observer.hpp"
#include "program/run_length.hpp"
#include "program/status_line.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace graze {

/// A line on standard error about how far a long run has come and how long it will take.
class Progress {
public:
    Progress(const Console& console, bool wanted) : line_(console, wanted) {}

    /// @param fraction done so far; empty when the end is not known
    void update(std::optional<double> fraction, double time);

private:
    StatusLine line_;
    int calls_ = 0;
};

/// Decides when a leg of a run is over, and lets recorders see the leg that is to be shown.
class RunControl : public Observer {
public:
    /// @param period_probe index of the probe whose passages are periods
    /// @param counted whether contacts at each event count
    RunControl(Observer& recorders, Progress& progress, std::optional<std::size_t> period_probe,
               std::vector<bool> counted);

    void begin(const LegEnd& end, double time, bool shown);
    /// Ends the run also when what is recorded of it fills the memory.
    void end_when(std::function<bool()> is_full) { is_full_ = std::move(is_full); }

    void step(const Step& step) override;
    void contact(const Contact& contact) override;
    void passage(const Passage& passage) override;
    void minimum(const StepMinimum& minimum) override;
    bool stop() override;

private:
    bool is_reached() const;

    Observer* recorders_;
    Progress* progress_;
    std::optional<std::size_t> period_probe_;
    std::vector<bool> counted_;
    std::function<bool()> is_full_ = [] { return false; };
    LegEnd end_;
    double start_ = 0, time_ = 0;
    std::size_t periods_ = 0, contacts_ = 0;
    bool shown_ = false;
};

} // namespace graze
