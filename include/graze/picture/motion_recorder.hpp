#pragma once

#include "graze/model/named_value.hpp"
#include "graze/results/quantity_evaluator.hpp"
#include "graze/trajectory/observer.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// What is drawn of a motion. Panels refer to columns.
struct MotionPanelChoice {
    std::vector<NamedValue> columns;
    std::vector<std::size_t> histories;                         ///< drawn over time
    std::vector<std::pair<std::size_t, std::size_t>> portraits; ///< one over the other
    std::vector<bool> marked;                                   ///< events whose contacts are marked
    std::size_t sections = 0;                                   ///< the probes before this one are marked
    bool chosen = false; ///< the histories were asked for, and are drawn even where nothing changes
};

/// Keeps what a picture needs: points close enough on every arc, contacts before and after, passages of sections.
class MotionRecorder : public Observer {
public:
    struct Arc {
        std::vector<double> times;
        std::vector<double> values; ///< [point * columns + column]
    };
    struct Jump {
        double time;
        std::vector<double> before, after;
        bool marked;
    };
    struct Point {
        double time;
        std::vector<double> values;
    };

    MotionRecorder(const Simulation& simulation, MotionPanelChoice contents);

    void step(const Step& step) override;
    void contact(const Contact& contact) override;
    void passage(const Passage& passage) override;
    void finish(const Trajectory& trajectory);

    const MotionPanelChoice& contents() const { return contents_; }
    const Model& model() const { return simulation_.model(); }
    const std::vector<Arc>& arcs() const { return arcs_; }
    const std::vector<Jump>& jumps() const { return jumps_; }
    const std::vector<Point>& passages() const { return passages_; }
    std::string section_names() const;
    /// Period of a column that is a cyclic state; 0 for others.
    double period(std::size_t column) const { return column_periods_[column]; }
    std::optional<double> singularity() const { return singularity_; }
    /// False when the run was too long for a picture, which then shows its beginning.
    bool is_complete() const { return complete_; }

private:
    std::vector<double> evaluate(std::span<const double> state);

    Simulation simulation_;
    MotionPanelChoice contents_;
    QuantityEvaluator evaluate_;
    std::vector<double> periods_, column_periods_, state_;
    std::vector<Arc> arcs_;
    std::vector<Jump> jumps_;
    std::vector<Point> passages_;
    std::optional<double> singularity_;
    std::size_t points_ = 0;
    bool new_arc_ = true, complete_ = true;
};

} // namespace graze
