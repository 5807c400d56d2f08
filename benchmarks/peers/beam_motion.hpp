#pragma once

#include "motion.hpp"

#include "graze/model/microbeam.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace peers {

/// The microbeam with a compliant stop (chapter 3 of the dissertation): amplitudes, velocities, phase of the pulses.
/// Derivatives by a parameter are those by the voltage. Modes of motion as in the model: 0 and 1 without contact, 2 and
/// 3 with it, the voltage on in 0 and 2.
template <class Real>
class BeamMotion : public Motion<Real> {
public:
    explicit BeamMotion(const graze::MicrobeamOptions& options)
        : count_(static_cast<std::size_t>(options.modes)), options_(options) {
        const graze::ClampedBeamModes beam(options.modes);
        for (std::size_t i = 0; i < count_; ++i) {
            frequencies_.push_back(beam.frequency(number(i)));
            at_stop_.push_back(beam.shape(number(i), options.stop_position));
            at_centre_.push_back(beam.shape(number(i), 0.5));
            for (std::size_t j = 0; j < count_; ++j)
                slopes_.push_back(beam.slope_product(number(i), number(j)));
        }
        fringe_ = 0.204 + 0.6 * std::pow(options.thickness / options.width, 0.24);
        // Simpson's rule; the ends do not move.
        for (int j = 1; j < options.points; ++j) {
            Node node;
            node.weight = Real(j % 2 == 1 ? 4 : 2) / (3 * Real(options.points));
            for (std::size_t i = 0; i < count_; ++i)
                node.shapes.push_back(beam.shape(number(i), static_cast<double>(j) / options.points));
            nodes_.push_back(std::move(node));
        }
    }

    std::size_t states() const override { return 2 * count_ + 1; }
    void rates(std::size_t mode, const Real* x, Real* rates) const override {
        const Real *q = x, *v = x + count_;
        Real stretch = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            slope_[i] = product(&slopes_[i * count_], q);
            stretch += slope_[i] * q[i];
        }
        const Real stop = is_contact(mode) ? stiffness_ * (distance_ - product(at_stop_.data(), q)) : 0;
        for (std::size_t i = 0; i < count_; ++i) {
            rates[i] = v[i];
            rates[count_ + i] = -2 * damping_ * frequencies_[i] * v[i] - frequencies_[i] * frequencies_[i] * q[i] -
                                gamma_ / 2 * stretch * slope_[i] + at_stop_[i] * stop;
        }
        rates[2 * count_] = options_.frequency;
        if (!is_on(mode))
            return;
        for (const Node& node : nodes_) {
            const Real pull = voltage_ * voltage_ * node.weight * pressure(gap(node, q)).value;
            for (std::size_t i = 0; i < count_; ++i)
                rates[count_ + i] += pull * node.shapes[i];
        }
    }
    void derivative_rates(std::size_t mode, const Real* x, std::span<const Real* const> columns,
                          std::span<Real* const> rates) const override {
        find_stiffness(mode, x);
        for (std::size_t j = 0; j < columns.size(); ++j) {
            const Real *s = columns[j], *w = s + count_;
            for (std::size_t i = 0; i < count_; ++i) {
                rates[j][i] = w[i];
                rates[j][count_ + i] = product(&matrix_[i * count_], s) - 2 * damping_ * frequencies_[i] * w[i];
            }
            rates[j][2 * count_] = 0;
        }
        if (is_on(mode))
            for (const Node& node : nodes_)
                for (std::size_t i = 0; i < count_; ++i)
                    rates.back()[count_ + i] +=
                        2 * voltage_ * node.weight * pressure(gap(node, x)).value * node.shapes[i];
    }
    void jacobian(std::size_t mode, const Real* x, const typename Motion<Real>::Entry& entry) const override {
        find_stiffness(mode, x);
        for (std::size_t i = 0; i < count_; ++i) {
            entry(i, count_ + i, 1);
            for (std::size_t j = 0; j < count_; ++j)
                entry(count_ + i, j, matrix_[i * count_ + j]);
            entry(count_ + i, count_ + i, -2 * damping_ * frequencies_[i]);
        }
    }

    /// Surfaces: end or start of the pulse, the stop, and the electrode while the voltage is off.
    std::size_t surfaces(std::size_t mode) const override { return is_on(mode) ? 2 : 3; }
    void distances(std::size_t mode, const Real* x, Real* values) const override {
        const Real clearance = product(at_stop_.data(), x) - distance_;
        values[0] = turn(mode) - x[2 * count_];
        values[1] = is_contact(mode) ? -clearance : clearance;
        if (!is_on(mode))
            values[2] = options_.gap - product(at_centre_.data(), x);
    }
    Real gradient_times(std::size_t mode, std::size_t surface, const Real* column) const override {
        if (surface == 0)
            return -column[2 * count_];
        const Real along = product((surface == 1 ? at_stop_ : at_centre_).data(), column);
        return surface == 2 || is_contact(mode) ? -along : along;
    }
    std::size_t cross(std::size_t mode, std::size_t surface, Real* x) const override {
        if (surface == 0)
            x[2 * count_] = is_on(mode) ? turn(mode) : 0;
        return mode ^ (surface == 0 ? 1U : 2U);
    }
    /// Setting the phase to its current value changes derivatives across the motion, not along it.
    void cross_derivative(std::size_t, std::size_t surface, Real* column) const override {
        if (surface == 0)
            column[2 * count_] = 0;
    }

private:
    struct Node {
        Real weight;
        std::vector<Real> shapes;
    };
    struct Pressure {
        Real value, slope;
    };
    static int number(std::size_t i) { return static_cast<int>(i) + 1; }
    static bool is_on(std::size_t mode) { return mode % 2 == 0; }
    static bool is_contact(std::size_t mode) { return mode >= 2; }
    static Real turn(std::size_t mode) { return std::numbers::pi * (is_on(mode) ? 1 : 2); }
    Real product(const Real* a, const Real* b) const {
        Real sum = 0;
        for (std::size_t i = 0; i < count_; ++i)
            sum += a[i] * b[i];
        return sum;
    }
    Real gap(const Node& node, const Real* q) const { return options_.gap - product(node.shapes.data(), q); }
    Pressure pressure(Real gap) const {
        using std::pow;
        const Real field = fringe_ * pow(gap / width_, Real(0.76)), value = (1 + field) / (gap * gap);
        return {value, 0.76 * field / (gap * gap * gap) - 2 * value / gap};
    }
    /// Derivatives of the accelerations by the amplitudes.
    void find_stiffness(std::size_t mode, const Real* q) const {
        Real stretch = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            slope_[i] = product(&slopes_[i * count_], q);
            stretch += slope_[i] * q[i];
        }
        for (std::size_t i = 0; i < count_; ++i)
            for (std::size_t j = 0; j < count_; ++j) {
                Real sum = -gamma_ / 2 * (2 * slope_[i] * slope_[j] + stretch * slopes_[i * count_ + j]);
                if (i == j)
                    sum -= frequencies_[i] * frequencies_[i];
                if (is_contact(mode))
                    sum -= at_stop_[i] * stiffness_ * at_stop_[j];
                matrix_[i * count_ + j] = sum;
            }
        if (!is_on(mode))
            return;
        for (const Node& node : nodes_) {
            const Real pull = -voltage_ * voltage_ * node.weight * pressure(gap(node, q)).slope;
            for (std::size_t i = 0; i < count_; ++i)
                for (std::size_t j = 0; j < count_; ++j)
                    matrix_[i * count_ + j] += pull * node.shapes[i] * node.shapes[j];
        }
    }

    std::size_t count_;
    graze::MicrobeamOptions options_;
    Real fringe_ = 0;
    Real gamma_ = options_.gamma, damping_ = options_.damping, stiffness_ = options_.stop_stiffness,
         distance_ = options_.stop_distance, voltage_ = options_.voltage, width_ = options_.width;
    std::vector<Real> frequencies_, at_stop_, at_centre_, slopes_;
    std::vector<Node> nodes_;
    mutable std::vector<Real> slope_ = std::vector<Real>(count_), matrix_ = std::vector<Real>(count_ * count_);
};

} // namespace peers
