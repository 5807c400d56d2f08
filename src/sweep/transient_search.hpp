#pragma once

#include "graze/sweep/point_search.hpp"
#include "graze/trajectory/observer.hpp"
#include "sweep/sample_recorder.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// Label of a motion that ended by itself, before anything was reached.
Label label_of(Ending ending);

/// What all searches of a run share.
struct TransientSetting {
    TransientSetting(const System& system, const TransientOptions& given, const std::vector<Sampling>& samplings,
                     const std::vector<Expression>& values, const SimulationOptions& simulation_options);

    TransientOptions options;
    SampleRecorder::Layout layout;
    Simulation simulation;
    std::vector<bool> counted; ///< contacts at each event
};

/// Follows a motion for the time or count asked for.
class TransientSearch : public PointSearch, private Observer {
public:
    explicit TransientSearch(std::shared_ptr<const TransientSetting> setting);

    void begin(std::span<const double> parameters, std::span<const double> state, std::size_t mode) override;
    Trajectory& trajectory() override { return *trajectory_; }
    bool proceed() override;
    PointResult& result() override { return result_; }

private:
    void step(const Step& step) override;
    void contact(const Contact& contact) override;
    void passage(const Passage& passage) override;
    bool stop() override;
    double end_of(double time) const;
    bool waits_in_vain();
    Outcome end_in_vain() const;

    std::shared_ptr<const TransientSetting> setting_;
    SampleRecorder recorder_;
    std::optional<Trajectory> trajectory_;
    std::size_t periods_ = 0, contacts_ = 0, all_periods_ = 0;
    std::size_t waited_ = 0; ///< steps since something brought the end nearer
    bool shown_ = false;     ///< the time that is sampled has begun
    bool reached_ = false, stop_ = false, escaped_ = false;
    PointResult result_;
};

} // namespace graze
