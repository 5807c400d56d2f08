#pragma once

#include "graze/trajectory/observer.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace graze {

/// Forwards all calls to several observers, in their order. Stops as soon as one of them does.
class Relay : public Observer {
public:
    /// @throws InputError for a null observer
    explicit Relay(std::vector<std::shared_ptr<Observer>> observers);

    void step(const Step& step) override;
    void contact(const Contact& contact) override;
    void passage(const Passage& passage) override;
    void minimum(const StepMinimum& minimum) override;
    bool stop() override;

private:
    std::vector<std::shared_ptr<Observer>> observers_;
};

/// Stores all contacts and passages, with their states.
class Recorder : public Observer {
public:
    struct RecordedContact {
        Contact contact; ///< its spans are empty; see the vectors
        std::vector<double> before, after;
    };
    struct RecordedPassage {
        Passage passage; ///< its span is empty
        std::vector<double> state;
    };

    void contact(const Contact& contact) override;
    void passage(const Passage& passage) override;

    const std::vector<RecordedContact>& contacts() const { return contacts_; }
    const std::vector<RecordedPassage>& passages() const { return passages_; }
    void clear();

private:
    std::vector<RecordedContact> contacts_;
    std::vector<RecordedPassage> passages_;
};

/// A copy of a step with all of its series.
struct RecordedStep {
    double start = 0, length = 0;
    std::size_t mode = 0, states = 0;
    int order = 0;
    std::vector<double> coefficients; ///< of states, watched events, observed expressions: order + 1 of each

    /// Returns a state at start + s. @throws InputError for an unknown state
    double state(std::size_t index, double s) const;
};

/// Keeps copies of all steps, and so the states at any time. A step takes 8 (order + 1) bytes per series.
class StepRecorder : public Observer {
public:
    void step(const Step& step) override;
    const std::vector<RecordedStep>& steps() const { return steps_; }
    void clear() { steps_.clear(); }

private:
    std::vector<RecordedStep> steps_;
};

/// Samples states at given times from the Taylor polynomials of the steps: accurate to the tolerance, without influence
/// on the steps. A time at which a contact occurs belongs to the arc before it.
class Sampler : public Observer {
public:
    /// @param state valid during the call
    using Receiver = std::function<void(double time, std::size_t mode, std::span<const double> state)>;

    /// Samples at start, start + spacing, ..., `count` times in all.
    /// @param periods one for each state (0 if not cyclic); states are reduced to them
    /// @throws InputError for a wrong number of periods
    Sampler(double start, double spacing, std::size_t count, std::vector<double> periods, Receiver receiver);

    void step(const Step& step) override;
    /// Returns the number of samples taken.
    std::size_t taken() const { return taken_; }
    double spacing() const { return spacing_; }
    /// Returns the time of the next sample.
    double next() const { return start_ + static_cast<double>(taken_) * spacing_; }
    /// Doubles the spacing, as if every other sample had not been taken. To be called by the receiver of the second,
    /// fourth, ... sample.
    void coarsen();

private:
    double start_, spacing_;
    std::size_t count_, taken_ = 0;
    std::vector<double> periods_, state_;
    Receiver receiver_;
};

/// The least value of one event function over one arc, from contact to contact.
struct ArcMinimum {
    std::size_t arc = 0; ///< counts from 0
    std::size_t mode = 0, event = 0;
    double start = 0, end = 0; ///< start and end time of the arc
    double time = 0, value = 0;
    double lower_bound = 0; ///< guaranteed
};

/// Collects the minima of steps over arcs. Needs SimulationOptions::minima.
class ArcMinima : public Observer {
public:
    using Receiver = std::function<void(const ArcMinimum&)>;
    explicit ArcMinima(Receiver receiver);

    void step(const Step& step) override;
    void contact(const Contact& contact) override;
    void minimum(const StepMinimum& minimum) override;
    /// Reports the minima of the arc in progress; to be called at the end of the trajectory.
    void finish();

private:
    Receiver receiver_;
    std::vector<ArcMinimum> current_; ///< in the order of the mode's watched events
    std::size_t arc_ = 0, mode_ = 0;
    double start_ = 0, end_ = 0;
    bool begun_ = false;
};

} // namespace graze
