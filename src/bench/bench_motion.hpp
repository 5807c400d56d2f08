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

/// A model's motion under a generator.
class BenchMotion {
public:
    struct Moment {
        double time = 0; ///< in seconds
        std::size_t mode = 0;
        std::vector<double> state{};
        std::string ended{};
    };

    explicit BenchMotion(const BenchSettings& settings);

    /// From now on.
    void drive(const GeneratorOutput& output);
    double time() const { return now_.time; }
    const std::string& ended() const { return now_.ended; }
    Moment moment();
    void go_back(const Moment& moment);

    /// @param values of the channels, valid during the call
    using Receiver = std::function<void(std::span<const double> values)>;
    /// Values now, `spacing` seconds later, and so on; then it is count spacings later.
    void advance(double spacing, std::size_t count, const Receiver& receiver);

private:
    /// Hands on to whoever listens at the time.
    class Listener : public Observer {
    public:
        Observer* to = nullptr;
        void step(const Step& step) override {
            if (to != nullptr)
                to->step(step);
        }
    };
    void go_on(double spacing, std::size_t count);
    void note_end();

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
    std::optional<Trajectory> trajectory_; ///< none: it begins anew from now
    double began_ = 0;                     ///< the trajectory counts its time from here
};

} // namespace graze
