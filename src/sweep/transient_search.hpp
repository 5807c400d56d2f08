#pragma once

#include "graze/sweep/point_search.hpp"
#include "sweep/sample_recorder.hpp"

#include <memory>
#include <optional>

namespace graze {

/// Returns the label of a motion that ended by itself before the requested end.
Label label_of(Ending ending);

/// Creates searches that share a setting, made from the arguments of `attractor_searches` or `transient_searches`.
template <class Setting, class Search>
class SearchesOf : public SearchFactory {
public:
    explicit SearchesOf(const auto&... arguments) : setting_(std::make_shared<const Setting>(arguments...)) {}

    const Simulation& simulation() const override { return setting_->simulation; }
    std::unique_ptr<PointSearch> make() const override { return std::make_unique<Search>(setting_); }

private:
    std::shared_ptr<const Setting> setting_;
};

/// Data shared by all searches of a run.
struct TransientSetting {
    TransientSetting(const System& system, const TransientOptions& given, const std::vector<Sampling>& samplings,
                     const std::vector<Expression>& values, const SimulationOptions& simulation_options);

    TransientOptions options;
    SampleRecorder::Layout layout;
    Simulation simulation;
    std::vector<bool> counted; ///< whether contacts at each event are counted
};

/// Follows a motion for a given time or count.
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
    bool has_stalled();
    Outcome stalled_outcome() const;

    std::shared_ptr<const TransientSetting> setting_;
    SampleRecorder recorder_;
    std::optional<Trajectory> trajectory_;
    std::size_t periods_ = 0, contacts_ = 0, all_periods_ = 0;
    std::size_t waited_ = 0; ///< steps since the last event that brought the end nearer
    bool shown_ = false;     ///< the sampled part has begun
    bool reached_ = false, stop_ = false, escaped_ = false;
    PointResult result_;
};

} // namespace graze
