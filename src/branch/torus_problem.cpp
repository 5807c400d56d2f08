#include "branch/torus_problem.hpp"

#include "base/linear_systems.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace graze {

Eigen::VectorXd circle_functions(std::size_t harmonics, double turns) {
    Eigen::VectorXd values(index(2 * harmonics + 1));
    values[0] = 1;
    for (std::size_t k = 1; k <= harmonics; ++k) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(k) * turns;
        values[index(2 * k - 1)] = std::cos(angle);
        values[index(2 * k)] = std::sin(angle);
    }
    return values;
}

Eigen::VectorXd circle_function_rates(std::size_t harmonics, double turns) {
    const Eigen::VectorXd values = circle_functions(harmonics, turns);
    Eigen::VectorXd rates = Eigen::VectorXd::Zero(values.size());
    for (std::size_t k = 1; k <= harmonics; ++k) {
        const double factor = 2 * std::numbers::pi * static_cast<double>(k);
        rates[index(2 * k - 1)] = -factor * values[index(2 * k)];
        rates[index(2 * k)] = factor * values[index(2 * k - 1)];
    }
    return rates;
}

TorusProblem::TorusProblem(TorusSetting setting, std::size_t harmonics)
    : setting_(std::move(setting)), harmonics_(harmonics), scales_(unknowns(), 1.0),
      durations_(terms(), setting_.back->first().durations) {
    for (std::size_t term = 0; term < terms(); ++term)
        for (std::size_t a = 0; a < setting_.active.size(); ++a)
            scales_[place_of(term, a)] = setting_.scales[index(setting_.active[a])];
    scales_[parameter_place()] = setting_.parameter_scale;
}

Torus TorusProblem::torus_of(std::span<const double> u) const {
    const Orbit& first = setting_.back->first();
    Torus torus{first.parameters, u[rotation_place()], {}};
    torus.parameters[setting_.parameter.place()] = u[parameter_place()];
    torus.terms.assign(terms(), std::vector<double>(first.starts[0].size(), 0.0));
    torus.terms[0] = first.starts[0];
    for (std::size_t term = 0; term < terms(); ++term)
        for (std::size_t a = 0; a < setting_.active.size(); ++a)
            torus.terms[term][setting_.active[a]] = u[place_of(term, a)];
    return torus;
}

std::vector<double> TorusProblem::extended(std::span<const double> fewer) const {
    std::vector<double> more(unknowns(), 0.0);
    std::copy(fewer.begin(), fewer.end() - 2, more.begin());
    std::copy(fewer.end() - 2, fewer.end(), more.end() - 2);
    return more;
}

double TorusProblem::largest_from(std::size_t first_term, std::span<const double> u) const {
    double largest = 0;
    for (std::size_t place = place_of(first_term, 0); place < rotation_place(); ++place)
        largest = std::max(largest, std::abs(u[place]) / scales_[place]);
    return largest;
}

double TorusProblem::tail_of(std::span<const double> u) const {
    constexpr std::size_t last = 4; // terms of two harmonics
    const double largest = largest_from(1, u);
    return largest > 0 ? largest_from(std::max<std::size_t>(terms(), last + 1) - last, u) / largest : 0;
}

std::shared_ptr<TorusProblem> TorusProblem::with_harmonics(std::size_t harmonics) const {
    auto finer = std::make_shared<TorusProblem>(setting_, harmonics);
    for (std::size_t j = 0; j < finer->terms(); ++j)
        finer->durations_[j] = durations_[j * terms() / finer->terms()];
    finer->set_parameter_scale(scales_[parameter_place()]);
    return finer;
}

bool TorusProblem::evaluate(std::span<const double> u) {
    if (std::ranges::equal(u, at_))
        return true;
    at_.clear();
    const auto actives = index(setting_.active.size());
    const Eigen::MatrixXd circle = Eigen::Map<const Eigen::MatrixXd>(u.data(), actives, index(terms()));
    std::vector<SignatureReturn::Image> images;
    for (std::size_t j = 0; j < terms(); ++j) {
        const double turns = static_cast<double>(j) / static_cast<double>(terms());
        const Eigen::VectorXd here = circle * circle_functions(harmonics_, turns);
        std::vector<double> state = setting_.back->first().starts[0];
        for (std::size_t a = 0; a < setting_.active.size(); ++a)
            state[setting_.active[a]] = here[index(a)];
        auto image = setting_.back->follow(state, u[parameter_place()], durations_[j]);
        if (!image) {
            problem_ = setting_.back->problem();
            return false;
        }
        images.push_back(std::move(*image));
    }
    images_ = std::move(images);
    for (std::size_t j = 0; j < terms(); ++j)
        durations_[j] = images_[j].motion.durations;
    at_.assign(u.begin(), u.end());
    assemble(circle, u[rotation_place()]);
    return true;
}

void TorusProblem::assemble(const Eigen::MatrixXd& circle, double rotation) {
    const auto actives = index(setting_.active.size());
    const auto size = index(unknowns());
    matrix_ = Eigen::MatrixXd::Zero(size - 2, size);
    residuals_.resize(size - 2);
    const Eigen::VectorXd scales = setting_.scales(setting_.active);
    for (std::size_t j = 0; j < terms(); ++j) {
        const double turns = static_cast<double>(j) / static_cast<double>(terms());
        const Eigen::VectorXd from = circle_functions(harmonics_, turns),
                              to = circle_functions(harmonics_, turns + rotation),
                              rates = circle_function_rates(harmonics_, turns + rotation);
        const SignatureReturn::Image& image = images_[j];
        const Eigen::VectorXd after = vector_of(image.after)(setting_.active);
        const Eigen::MatrixXd of_states = scales.cwiseInverse().asDiagonal() *
                                          image.derivatives(setting_.active, setting_.active) * scales.asDiagonal();
        const Eigen::Index first = index(j) * actives;
        residuals_.segment(first, actives) = (after - circle * to).cwiseQuotient(scales);
        auto rows = matrix_.middleRows(first, actives);
        for (Eigen::Index term = 0; term < from.size(); ++term) {
            rows.middleCols(term * actives, actives) = from[term] * of_states;
            rows.middleCols(term * actives, actives).diagonal().array() -= to[term];
        }
        rows.col(size - 2) = -(circle * rates).cwiseQuotient(scales);
        const Eigen::VectorXd by_parameter = image.derivatives.col(image.derivatives.cols() - 1)(setting_.active);
        rows.col(size - 1) = by_parameter.cwiseQuotient(scales);
    }
}

void TorusProblem::accept(std::span<const double> u) {
    phase_ = Eigen::VectorXd::Zero(index(unknowns()));
    for (std::size_t k = 1; k <= harmonics_; ++k)
        for (std::size_t a = 0; a < setting_.active.size(); ++a) {
            const std::size_t even = place_of(2 * k - 1, a), odd = place_of(2 * k, a);
            phase_[index(even)] = static_cast<double>(k) * u[odd] / scales_[odd];
            phase_[index(odd)] = -static_cast<double>(k) * u[even] / scales_[even];
        }
    phase_.normalize();
}

bool TorusProblem::solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
                         double* determinant) {
    const auto size = index(unknowns());
    if (at_.empty() || phase_.size() != size)
        return false;
    const auto scales = vector_of(scales_);
    Eigen::MatrixXd bordered = Eigen::MatrixXd::Zero(size, size);
    bordered.topRows(size - 2) = matrix_;
    bordered.col(size - 1) *= scales_[parameter_place()];
    bordered.row(size - 2) = phase_;
    bordered.row(size - 1) = vector_of(row).cwiseProduct(scales);
    Eigen::VectorXd values = Eigen::VectorXd::Zero(size);
    if (!homogeneous) {
        values.head(size - 2) = -residuals_;
        values[size - 2] = -phase_.dot(vector_of(at_).cwiseQuotient(scales));
    }
    values[size - 1] = right;
    const Eigen::VectorXd result = PartialLU(bordered).solve(values);
    if (determinant)
        *determinant = 1; // branch points of tori are not looked for
    if (!result.allFinite())
        return false;
    entries_of(step) = result.cwiseProduct(scales);
    return true;
}

} // namespace graze
