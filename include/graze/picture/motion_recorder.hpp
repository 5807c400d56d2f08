#pragma once

#include "graze/model/named_value.hpp"
#include "graze/results/quantity_evaluator.hpp"
#include "graze/study/point_motion.hpp"
#include "graze/trajectory/observer.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// The contents of a picture of a motion. Panels refer to columns by their indices.
struct MotionPanelChoice {
    std::vector<NamedValue> columns;
    std::vector<std::size_t> histories;                         ///< columns drawn over time
    std::vector<std::pair<std::size_t, std::size_t>> portraits; ///< pairs of columns, x and y
    std::vector<bool> marked;                                   ///< for each event: its contacts are marked
    std::size_t sections = 0;                                   ///< the first `sections` probes are marked
    bool chosen = false; ///< the user chose the histories: constant ones are drawn too

    /// Index of the column of a quantity, which is added where there is none of its name.
    std::size_t column(NamedValue quantity);
};

/// Observer that records what a picture of a trajectory needs: dense points on every arc, the points before and after
/// each contact, and passages of sections.
class MotionRecorder : public Observer {
public:
    /// The time, then the value of each column.
    using Row = std::vector<double>;
    /// The rows just before and after a contact.
    struct Jump {
        Row before, after;
        bool marked;
    };

    /// A step of high order covers a large part of an oscillation; superfluous points are left out before drawing.
    static constexpr int usual_points_of_step = 32;

    MotionRecorder(const Simulation& simulation, MotionPanelChoice contents, int points_of_step = usual_points_of_step);
    /// To be called before a trajectory whose parameters are not those of the simulation's model.
    void set_parameters(std::span<const double> values);

    void step(const Step& step) override;
    void contact(const Contact& contact) override;
    void passage(const Passage& passage) override;
    void finish(const Trajectory& trajectory);

    const MotionPanelChoice& contents() const { return contents_; }
    const Model& model() const { return simulation_.model(); }
    /// The recorded motion; its values are the time and the columns.
    const DenseMotion& motion() const { return motion_; }
    const std::vector<Jump>& jumps() const { return jumps_; }
    const std::vector<Row>& passages() const { return passages_; }
    /// Names of the marked sections, separated by commas.
    std::string section_names() const;
    /// Time of the singularity at which the motion ended; none if it ended otherwise.
    std::optional<double> singularity() const {
        return motion_.outcome.ending == Ending::singular ? std::optional(motion_.outcome.time) : std::nullopt;
    }
    /// False when the motion was too long: only its beginning is recorded.
    bool is_complete() const { return complete_; }

private:
    Row row_of(double time, std::span<const double> state);

    Simulation simulation_;
    MotionPanelChoice contents_;
    QuantityEvaluator evaluate_;
    int points_of_step_;
    std::vector<double> periods_, state_;
    DenseMotion motion_;
    std::vector<Jump> jumps_;
    std::vector<Row> passages_;
    bool new_arc_ = true, after_impact_ = false, complete_ = true;
};

} // namespace graze
