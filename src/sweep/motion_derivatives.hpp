#pragma once

#include "graze/trajectory/observer.hpp"
#include "sweep/step_maps.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace graze {

/// Derivatives of a motion by where it was, computed from its steps and contacts after they have been seen: those of
/// the steps in lanes, those of contacts by the saltation formulas (as Tangents does along with the motion). They do
/// not pass accumulations of contacts.
///
/// Derivatives are those at fixed time, states x columns.
class MotionDerivatives {
public:
    /// @param maps to compute with, also for others in turn
    explicit MotionDerivatives(const VariationalModes& modes, StepMaps& maps);

    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

    /// A place along the motion that was marked.
    struct Mark {
        double time = 0;
        std::size_t mode = 0;
        std::span<const double> state;
    };
    /// Told of each mark, in their order, when derivatives have come to it; may set others.
    using AtMark = std::function<void(const Mark& mark)>;

    /// @param scale of each state; @param derivatives at the beginning
    void begin(std::span<const double> parameters, std::span<const double> scale, Matrix derivatives,
               AtMark at_mark = {});

    // What is seen, in this order. Nothing is computed before `carry`, unless it becomes much.
    /// A mark within the step that comes next, or at its end.
    void mark_ahead(double time, std::size_t mode, std::span<const double> state);
    void step(const Step& step);
    void contact(const Contact& contact);
    /// The motion met a surface without speed: derivatives do not exist from there on.
    void grazing();
    /// A mark at the present place.
    void mark(double time, std::size_t mode, std::span<const double> state);

    /// Carries derivatives along all that has been seen.
    void carry();
    /// Where they have been carried to.
    const Matrix& derivatives() const { return derivatives_; }
    bool valid() const { return valid_; }
    /// Whether contacts have accumulated: nothing is noted of what came behind.
    bool broken() const { return broken_; }
    /// Others instead, which are valid.
    void set(Matrix derivatives);

private:
    struct Item {
        enum class Kind { step, contact, grazing, mark } kind = Kind::step;
        std::size_t mode = 0, mode_after = 0;  ///< there; before and after the contact
        std::size_t event = 0, transition = 0; ///< of the contact
        double rate = 0;                       ///< of the event's function before the contact
        double time = 0;                       ///< of the mark; length of the step
        std::size_t numbers = 0;               ///< where states are: of start or mark; before, then after the contact
        std::size_t map = 0;                   ///< of the step, once it is known
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
