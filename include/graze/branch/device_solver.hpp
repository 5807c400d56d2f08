#pragma once

#include "graze/branch/yield.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace graze {

/// What is to be found of each device beyond its value, such as how long its trip takes.
struct DeviceExamination {
    /// All that `examine` depends on besides the solver and the device, so that another process can make the same one.
    std::string request;
    /// Called by any thread, by several at once. @return what was found, as bytes that only the caller of the yield
    /// reads; where it was interrupted, what is known by then
    std::function<std::string(const LocatedSolution& device, const std::function<bool()>& interrupted)> examine;
};

/// What has been found of a device.
struct SolvedDevice {
    Device device;
    std::string problem;  ///< why it was not found; empty otherwise
    std::string examined; ///< by its examination; empty where there is none, and for a device that was not found
};

/// Solves for the special point of devices whose parameters differ from those of a nominal one. Each device is solved
/// for by itself, from the nominal one, so that the results do not depend on how devices are divided between threads
/// and processes, to the last bit. Can be used by several threads.
class DeviceSolver {
public:
    /// @param point of the nominal device; @param control the parameter that is solved for; @param others the
    /// parameters in which devices differ
    /// @throws InputError as LocatedValue does
    DeviceSolver(const System& system, const SpecialPoint& point, ParameterId control, std::vector<ParameterId> others,
                 const LocatedValueOptions& options, DeviceExamination examination = {});
    ~DeviceSolver();
    DeviceSolver(DeviceSolver&&) noexcept;

    const System& system() const;
    const SpecialPoint& point() const;
    ParameterId control() const;
    const std::vector<ParameterId>& others() const;
    const LocatedValueOptions& options() const;
    const DeviceExamination& examination() const;

    /// Of the nominal device, as LocatedValue.
    double value() const;
    const std::vector<double>& values() const;
    const std::vector<double>& derivatives() const;

    /// @param changes of the other parameters from those of the nominal device, one for each; none: the device cannot
    /// be made
    /// @param interrupted asked by the examination
    SolvedDevice solve(const std::vector<double>& changes, const std::function<bool()>& interrupted) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The devices of a yield, by their numbers from 0 on.
struct AskedDevices {
    const DeviceSolver& solver;
    std::size_t count = 0;
    /// The changes of a device, for DeviceSolver::solve. Called by any thread, by several at once.
    std::function<std::vector<double>(std::size_t device)> changes;
};

} // namespace graze
