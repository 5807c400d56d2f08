#pragma once

#include "graze/trajectory/observer.hpp"
#include "sweep/step_maps.hpp"

#include <Eigen/Core>

#include <functional>

namespace graze {

/// Derivatives of a motion with respect to an earlier state, computed from recorded steps and contacts: steps in lanes,
/// contacts by the saltation formulas (as Tangents does during the motion). They end at accumulations of contacts.
///
/// Derivatives are those at fixed time, states x columns.
class MotionDerivatives {
public:
    /// @param maps for the computation; may be shared with other objects in turn
    explicit MotionDerivatives(const VariationalModes& modes, StepMaps& maps);

    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

    /// A marked place of the motion.
    struct Mark {
        double time = 0;
        std::size_t mode = 0;
        std::span<const double> state;
    };
    /// Called for each mark, in order, when the derivatives have reached it; it may replace them by `set`.
    using AtMark = std::function<void(const Mark& mark)>;

    /// @param scale unit of each state; @param derivatives initial value
    void begin(std::span<const double> parameters, std::span<const double> scale, Matrix derivatives,
               AtMark at_mark = {});

    // The following functions record the motion in order. Computation is deferred to `carry`, unless much has been
    // recorded.
    /// Sets a mark within the next step, or at its end.
    void mark_ahead(double time, std::size_t mode, std::span<const double> state);
    void step(const Step& step);
    void contact(const Contact& contact);
    /// The motion met a surface at zero speed: derivatives do not exist from there on.
    void grazing();
    /// Sets a mark at the present place.
    void mark(double time, std::size_t mode, std::span<const double> state);

    /// Propagates the derivatives along everything recorded.
    void carry();
    /// Returns the propagated derivatives.
    const Matrix& derivatives() const { return derivatives_; }
    bool valid() const { return valid_; }
    /// True after an accumulation of contacts: nothing is recorded beyond it.
    bool broken() const { return broken_; }
    /// Replaces the derivatives; the new ones are valid.
    void set(Matrix derivatives);

private:
    struct Item {
        enum class Kind { step, contact, grazing, mark } kind = Kind::step;
        std::size_t mode = 0, mode_after = 0;  ///< mode; modes before and after the contact
        std::size_t event = 0, transition = 0; ///< of the contact
        double rate = 0;                       ///< rate of the event's function before the contact
        double time = 0;                       ///< time of the mark; length of the step
        std::size_t numbers = 0; ///< index of the state at the start or mark; of those before and after the contact
        std::size_t map = 0;     ///< index of the step's map, once added
    };
    struct Ahead {
        double time;
        std::size_t mode, numbers;
    };
    std::size_t keep(std::span<const double> state);
    void add_step(const Step& step, double from, double to);
    std::span<const double> state_at(std::size_t numbers) const { return {&numbers_[numbers], states_}; }
    void take(const Item& item);
    void pass_step(std::size_t map);
    void pass_contact(const Item& item);

    const VariationalModes* modes_;
    StepMaps* maps_;
    std::size_t states_;
    AtMark at_mark_;
    Matrix derivatives_, next_;
    bool valid_ = true, broken_ = false;
    std::vector<Item> items_;
    std::vector<Ahead> ahead_;
    std::vector<double> numbers_; ///< states
    std::vector<double> parameters_, scale_;
    std::vector<double> inputs_, work_, fields_, gradient_, jacobian_, shift_;
};

} // namespace graze
