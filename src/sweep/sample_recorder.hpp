#pragma once

#include "graze/flow/system.hpp"
#include "graze/sweep/sampling.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/trajectory/observer.hpp"
#include "graze/trajectory/probe.hpp"

#include <cstddef>
#include <deque>
#include <span>
#include <vector>

namespace graze {

/// Records the samples of a run along one motion.
class SampleRecorder {
public:
    /// Data shared by all recorders of a run; immutable.
    class Layout {
    public:
        /// @throws InputError for sections that the model does not have
        Layout(const System& system, const std::vector<Sampling>& samplings, const std::vector<Expression>& values);
        /// Returns the probes for samplings at sections and extrema, in their order, then that of a section if it has a
        /// name: its probe may end trajectories, and simultaneous passages must be reported before.
        std::vector<Probe> probes(const Model& model, const std::string& section) const;

    private:
        friend class SampleRecorder;
        std::vector<Probe> probes_;
        std::vector<std::size_t> sampling_of_probe_;
        std::vector<std::vector<std::size_t>> samplings_of_event_;
        std::vector<std::size_t> image_of_sampling_; ///< index in images_, or none
        std::vector<Function> images_;               ///< images under symmetries, in states and parameters
        Function values_, periods_;
        std::size_t states_ = 0, parameters_ = 0;
    };

    /// @param first_probe index of the layout's first probe in the simulation
    SampleRecorder(const Layout& layout, std::size_t first_probe);

    /// Clears the samples.
    void begin(std::span<const double> parameters);
    void set_origin(double time) { origin_ = time; }
    void passage(const Passage& passage);
    void contact(const Contact& contact);
    /// Records a motion at rest: each sampling except contacts gets this one value.
    void rest(double time, std::span<const double> state);
    /// Marks the end of a return to the section.
    void mark();
    /// Removes samples older than the last returns.
    void keep_last(std::size_t returns);
    SampleSet& samples() { return samples_; }

private:
    void record(std::size_t sampling, double time, std::span<const double> state);

    const Layout* layout_;
    std::size_t first_probe_;
    double origin_ = 0;
    std::vector<double> inputs_, image_, periods_, work_;
    SampleSet samples_;
    std::deque<std::size_t> marks_; ///< number of samples at the ends of returns
};

} // namespace graze
