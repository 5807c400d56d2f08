#pragma once

#include "graze/bench/bench_settings.hpp"
#include "graze/bench/generator_output.hpp"
#include "graze/trajectory/jet_set.hpp"
#include "graze/trajectory/recorder.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// The motion of a model that is driven by a generator.
class BenchMotion {
public:
    /// State of the motion at a time.
    struct Moment {
        double time = 0; ///< seconds
        std::size_t mode = 0;
        std::vector<double> state{};
        std::string ended{};
    };

    explicit BenchMotion(const BenchSettings& settings);

    /// Sets the generator from now on.
    void drive(const GeneratorOutput& output);
    double time() const { return now_.time; }
    const std::string& ended() const { return now_.ended; }
    Moment moment();
    void go_back(const Moment& moment);

    /// Receives the values of the channels. @param values valid during the call
    using Receiver = std::function<void(std::span<const double> values)>;
    /// Passes on values now, `spacing` seconds later, and so on, and advances time by count spacings.
    void advance(double spacing, std::size_t count, const Receiver& receiver);

private:
    /// Forwards steps to the current observer.
    class Listener : public Observer {
    public:
        Observer* to = nullptr;
        void step(const Step& step) override {
            if (to != nullptr)
                to->step(step);
        }
    };
    void go_on(double spacing, std::size_t count);

    Model model_;
    DrivenInput amplitude_, frequency_;
    std::optional<DrivenInput> offset_;
    double time_unit_;
    Simulation simulation_;
    JetSet jets_;
    Function channels_;
    std::vector<double> parameters_, periods_, inputs_, values_, work_;
    Listener listener_;
    Moment now_;
    std::optional<Trajectory> trajectory_; ///< empty: a new one starts from now_
    double began_ = 0;                     ///< start of the trajectory's time
};

} // namespace graze
