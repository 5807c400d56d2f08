#include "graze/branch/device_solver.hpp"

#include <mutex>
#include <optional>
#include <utility>

namespace graze {

struct DeviceSolver::State {
    State(const System& of_system, const SpecialPoint& of_point, ParameterId of_control,
          std::vector<ParameterId> of_others, const LocatedValueOptions& with_options,
          DeviceExamination with_examination)
        : system(of_system), point(of_point), control(of_control), others(std::move(of_others)), options(with_options),
          examination(std::move(with_examination)) {
        LocatedValue nominal = make();
        value = nominal.value();
        values = nominal.values();
        derivatives = nominal.derivatives();
        free.push_back(std::move(nominal));
    }

    LocatedValue make() const { return {system, point, control, others, options}; }
    /// Solves by a LocatedValue that no other thread uses. One that throws is not used again.
    LocatedSolution solve(const std::vector<double>& at) {
        std::optional<LocatedValue> located;
        {
            const std::lock_guard lock(mutex);
            if (!free.empty()) {
                located.emplace(std::move(free.back()));
                free.pop_back();
            }
        }
        if (!located)
            located.emplace(make());
        LocatedSolution found = (*located)(at);
        const std::lock_guard lock(mutex);
        free.push_back(std::move(*located));
        return found;
    }

    System system;
    SpecialPoint point;
    ParameterId control;
    std::vector<ParameterId> others;
    LocatedValueOptions options;
    DeviceExamination examination;
    double value = 0;
    std::vector<double> values, derivatives;
    std::mutex mutex; ///< of `free`
    std::vector<LocatedValue> free;
};

DeviceSolver::DeviceSolver(const System& system, const SpecialPoint& point, ParameterId control,
                           std::vector<ParameterId> others, const LocatedValueOptions& options,
                           DeviceExamination examination)
    : state_(std::make_unique<State>(system, point, control, std::move(others), options, std::move(examination))) {}
DeviceSolver::~DeviceSolver() = default;
DeviceSolver::DeviceSolver(DeviceSolver&&) noexcept = default;

const System& DeviceSolver::system() const {
    return state_->system;
}
const SpecialPoint& DeviceSolver::point() const {
    return state_->point;
}
ParameterId DeviceSolver::control() const {
    return state_->control;
}
const std::vector<ParameterId>& DeviceSolver::others() const {
    return state_->others;
}
const LocatedValueOptions& DeviceSolver::options() const {
    return state_->options;
}
const DeviceExamination& DeviceSolver::examination() const {
    return state_->examination;
}
double DeviceSolver::value() const {
    return state_->value;
}
const std::vector<double>& DeviceSolver::values() const {
    return state_->values;
}
const std::vector<double>& DeviceSolver::derivatives() const {
    return state_->derivatives;
}

SolvedDevice DeviceSolver::solve(const std::vector<double>& changes, const std::function<bool()>& interrupted) const {
    SolvedDevice solved;
    Device& device = solved.device;
    device.outcome = DeviceOutcome::failed;
    device.linear = value();
    if (changes.size() != values().size()) {
        solved.problem = "the device cannot be made";
        return solved;
    }
    std::vector<double> at = values();
    for (std::size_t k = 0; k < at.size(); ++k) {
        at[k] += changes[k];
        device.linear += derivatives()[k] * changes[k];
    }
    const LocatedSolution found = state_->solve(at);
    if (found.found)
        device.outcome = found.admissible ? DeviceOutcome::found : DeviceOutcome::inadmissible;
    if (device.outcome != DeviceOutcome::found) {
        solved.problem = found.problem.empty() ? "the model would not follow the orbit" : found.problem;
        return solved;
    }
    device.value = found.value;
    if (examination().examine)
        solved.examined = examination().examine(found, interrupted);
    return solved;
}

} // namespace graze
