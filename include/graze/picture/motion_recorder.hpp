#pragma once

#include "graze/model/named_value.hpp"
#include "graze/results/quantity_evaluator.hpp"
#include "graze/study/point_motion.hpp"
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
    /// The time, then each column.
    using Row = std::vector<double>;
    struct Jump {
        Row before, after;
        bool marked;
    };

    MotionRecorder(const Simulation& simulation, MotionPanelChoice contents);

    void step(const Step& step) override;
    void contact(const Contact& contact) override;
    void passage(const Passage& passage) override;
    void finish(const Trajectory& trajectory);

    const MotionPanelChoice& contents() const { return contents_; }
    const Model& model() const { return simulation_.model(); }
    /// Its values are the time and the columns.
    const DenseMotion& motion() const { return motion_; }
    const std::vector<Jump>& jumps() const { return jumps_; }
    const std::vector<Row>& passages() const { return passages_; }
    std::string section_names() const;
    std::optional<double> singularity() const { return singularity_; }
    /// False when the run was too long for a picture, which then shows its beginning.
    bool is_complete() const { return complete_; }

private:
    Row row_of(double time, std::span<const double> state);

    Simulation simulation_;
    MotionPanelChoice contents_;
    QuantityEvaluator evaluate_;
    std::vector<double> periods_, state_;
    DenseMotion motion_;
    std::vector<Jump> jumps_;
    std::vector<Row> passages_;
    std::optional<double> singularity_;
    bool new_arc_ = true, complete_ = true;
};

} // namespace graze
