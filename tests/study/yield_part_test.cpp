#include "graze/study/yield_part.hpp"

#include "base/message_of.hpp"
#include "branch/driven_oscillator.hpp"
#include "messages_in_threads.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <cstdint>
#include <functional>
#include <limits>

namespace graze::yield_part_test {

using namespace graze::testing;
using ::testing::HasSubstr;

/// A yield with devices that are found, inadmissible, and not found.
class YieldPartTest : public ::testing::Test {
protected:
    YieldPartTest() {
        settings_.devices = 90;
        settings_.least = 0.9 * known_.force();
        settings_.tolerances = {{model_.independent_parameter("omega"), Spread::uniform, 0.3},
                                {model_.independent_parameter("sigma"), Spread::normal, 0.9}};
    }

    /// Solves for the devices in parts of so many, the last part first, from bytes alone as another process does.
    /// @param parts that are solved for before it is interrupted
    DevicesElsewhere in_parts(std::size_t size, std::size_t parts = 1000) {
        return [this, size, parts](const AskedDevices& devices, const std::function<bool()>&, const DeviceSink& sink) {
            text_ = bytes_of(devices.solver);
            const DeviceSolver other = device_solver_of(text_);
            std::size_t done = 0;
            for (std::size_t last = devices.count; last > 0;) {
                if (done++ >= parts)
                    return false;
                const std::size_t first = last - std::min(size, last);
                part_ = part_of(devices, {first, last});
                solved_ = solved_part(other, part_, {});
                read_devices(devices, {first, last}, solved_, sink);
                last = first;
            }
            return true;
        };
    }
    Yield yield() const { return yield_of(system_, point_, force_, settings_); }

    DrivenOscillator known_;
    Model model_ = known_.model();
    System system_{model_};
    SpecialPoint point_ = known_.grazing(model_);
    ParameterId force_ = model_.independent_parameter("F");
    YieldSettings settings_;
    std::string text_, part_, solved_; ///< the last ones
};

void expect_same(const std::optional<ConfidenceInterval>& one, const std::optional<ConfidenceInterval>& other) {
    ASSERT_TRUE(one && other);
    EXPECT_EQ(one->value, other->value);
    EXPECT_EQ(one->low, other->low);
    EXPECT_EQ(one->high, other->high);
}

void expect_same(const Yield& one, const Yield& other) {
    EXPECT_EQ(one.nominal, other.nominal);
    EXPECT_EQ(one.interrupted, other.interrupted);
    ASSERT_EQ(one.devices.size(), other.devices.size());
    for (std::size_t i = 0; i < one.devices.size(); ++i) {
        EXPECT_EQ(one.devices[i].outcome, other.devices[i].outcome);
        EXPECT_EQ(one.devices[i].value, other.devices[i].value);
        EXPECT_EQ(one.devices[i].linear, other.devices[i].linear);
    }
    EXPECT_EQ(one.problems, other.problems);
    EXPECT_EQ(one.linear_deviation, other.linear_deviation);
    EXPECT_EQ(one.largest_departure, other.largest_departure);
    expect_same(one.mean, other.mean);
    expect_same(one.deviation, other.deviation);
    expect_same(one.within, other.within);
}

TEST_F(YieldPartTest, AnyDivisionGivesTheSameYield) {
    const Yield whole = yield();
    EXPECT_GT(whole.found, 0U);
    EXPECT_GT(whole.inadmissible + whole.failed, 0U);
    for (const std::size_t size : {1, 7, 1000}) {
        settings_.elsewhere = in_parts(size);
        expect_same(yield(), whole);
    }
}

TEST_F(YieldPartTest, GivenDevicesAreSolvedForInParts) {
    MadeDevices made{{model_.independent_parameter("omega"), model_.independent_parameter("sigma")}, {}};
    for (int i = 0; i < 20; ++i)
        made.values.push_back({known_.omega * (1 + 0.003 * i), known_.sigma * (1 - 0.002 * i)});
    made.values.emplace_back(); // it cannot be made
    const auto made_yield = [&] { return yield_of(system_, point_, force_, made, settings_); };
    const Yield whole = made_yield();
    EXPECT_EQ(whole.failed, 1U);
    settings_.elsewhere = in_parts(6);
    expect_same(made_yield(), whole);
}

TEST_F(YieldPartTest, KeepsWhatWasSolvedForWhenItIsInterrupted) {
    settings_.elsewhere = in_parts(20, 2);
    std::size_t told = 0;
    settings_.progress = [&](std::size_t devices) { told = devices; };
    const Yield some = yield();
    EXPECT_TRUE(some.interrupted);
    EXPECT_EQ(some.made, 40U);
    EXPECT_EQ(told, 40U);
    EXPECT_EQ(some.devices[49].outcome, DeviceOutcome::not_made);
    EXPECT_NE(some.devices[50].outcome, DeviceOutcome::not_made);
    EXPECT_EQ(solved_part(device_solver_of(text_), part_, [] { return true; }), "");
}

TEST_F(YieldPartTest, OtherProcessesSolveForTheDevices) {
    const Yield whole = yield();
    for (const std::size_t count : {1, 2, 3}) {
        testing::WorkersInThreads workers(count, count == 2 ? 2 : 1);
        settings_.elsewhere = workers->devices();
        Yield found;
        std::size_t told = 0;
        settings_.progress = [&](std::size_t devices) { told = devices; };
        workers->carry_out(
            [&](const std::function<bool()>& interrupted) {
                settings_.interrupted = interrupted;
                found = yield();
            },
            {});
        expect_same(found, whole);
        EXPECT_EQ(told, settings_.devices);
    }
}

TEST_F(YieldPartTest, OtherProcessesEndWhenTheYieldIsInterrupted) {
    testing::WorkersInThreads workers(2);
    settings_.devices = 5000;
    settings_.elsewhere = workers->devices();
    std::atomic<bool> is_interrupted = false;
    settings_.progress = [&](std::size_t devices) { is_interrupted = devices >= 7; };
    Yield some;
    workers->carry_out(
        [&](const std::function<bool()>& interrupted) {
            settings_.interrupted = interrupted;
            some = yield();
        },
        [&] { return is_interrupted.load(); });
    EXPECT_TRUE(some.interrupted);
    EXPECT_GE(some.made, 7U);
    EXPECT_LT(some.made, settings_.devices);
    // What fails there, or here, is told here; they go on with other work.
    EXPECT_THAT(testing::message_of([&] {
                    workers->carry_out([](const std::function<bool()>&) { throw InputError("no room", "make some"); },
                                       {});
                }),
                HasSubstr("no room"));
    settings_.devices = 20;
    settings_.progress = {};
    is_interrupted = false;
    workers->carry_out([&](const std::function<bool()>&) { some = yield(); }, {});
    EXPECT_FALSE(some.interrupted);
}

TEST_F(YieldPartTest, ASolverIsWrittenAsItWasRead) {
    settings_.elsewhere = in_parts(1000);
    yield();
    EXPECT_TRUE(is_device_solver(text_));
    EXPECT_FALSE(is_device_solver(part_));
    EXPECT_EQ(bytes_of(device_solver_of(text_)), text_);
}

/// Examinations are made again from their requests.
TEST_F(YieldPartTest, ExaminesDevices) {
    const MakeExamination make = [](const System&, const SpecialPoint&, ParameterId control,
                                    const std::string& request) -> DeviceExamination {
        return {request, [control, request](const LocatedSolution& device, const std::function<bool()>&) {
                    return request + std::to_string(device.orbit.parameters[control.place()]);
                }};
    };
    const DeviceSolver solver(system_, point_, force_, {model_.independent_parameter("sigma")}, {},
                              make(system_, point_, force_, "what? "));
    const std::string text = bytes_of(solver);
    const DeviceSolver other = device_solver_of(text, make);
    const AskedDevices devices{solver, 2, [](std::size_t i) { return std::vector<double>{i == 0 ? 0.01 : -2}; }};
    std::vector<std::string> examined;
    read_devices(devices, {0, 2}, solved_part(other, part_of(devices, {0, 2}), {}),
                 [&](std::size_t, SolvedDevice& one) { examined.push_back(one.examined); });
    const SolvedDevice here = solver.solve({0.01}, {});
    EXPECT_EQ(here.examined, "what? " + std::to_string(here.device.value));
    EXPECT_EQ(examined, (std::vector<std::string>{here.examined, ""}));
    EXPECT_THAT(message_of([&] { device_solver_of(text); }), HasSubstr("examined"));
}

TEST_F(YieldPartTest, RefusesWhatIsNoPart) {
    settings_.elsewhere = in_parts(1000);
    yield();
    const DeviceSolver solver = device_solver_of(text_);
    const AskedDevices devices{solver, 90, [](std::size_t) { return std::vector<double>(2); }};
    std::size_t read = 0;
    const auto refusal = [&](ItemRange range, const std::string& bytes) {
        return message_of([&] { read_devices(devices, range, bytes, [&](std::size_t, SolvedDevice&) { ++read; }); });
    };
    const auto is_no_part = HasSubstr("no part of a computation");
    EXPECT_EQ(refusal({0, 90}, solved_), "");
    EXPECT_EQ(read, 90U);
    for (std::size_t size = 0; size < solved_.size(); size += 1 + size / 7)
        EXPECT_THAT(refusal({0, 90}, solved_.substr(0, size)), is_no_part) << size;
    EXPECT_THAT(refusal({0, 89}, solved_), is_no_part);
    EXPECT_THAT(refusal({0, 90}, solved_ + "x"), is_no_part);
    EXPECT_THAT(refusal({0, 91}, solved_), HasSubstr("devices of a part"));
    EXPECT_THAT(refusal({3, 0}, solved_), HasSubstr("devices before a part"));
    std::string not_made = solved_;
    not_made[std::string("graze-solved-1\n").size()] = static_cast<char>(DeviceOutcome::not_made);
    EXPECT_THAT(refusal({0, 90}, not_made), is_no_part);
    EXPECT_EQ(read, 90U); // nothing of what is refused is given

    for (std::size_t size = 0; size < part_.size(); size += 1 + size / 7)
        EXPECT_THAT(message_of([&] { solved_part(solver, part_.substr(0, size), {}); }), is_no_part) << size;
    const AskedDevices wider{solver, 1, [](std::size_t) { return std::vector<double>(3); }};
    EXPECT_THAT(message_of([&] { solved_part(solver, part_of(wider, {0, 1}), {}); }), is_no_part);
    EXPECT_THAT(message_of([&] { part_of(devices, {4, 91}); }), HasSubstr("devices of a part"));
    const AskedDevices wild{
        solver, 1, [](std::size_t) { return std::vector<double>(2, std::numeric_limits<double>::infinity()); }};
    EXPECT_NE(message_of([&] { solved_part(solver, part_of(wild, {0, 1}), {}); }), "");
}

TEST_F(YieldPartTest, RefusesWhatIsNoSolver) {
    settings_.elsewhere = in_parts(1000);
    yield();
    for (std::size_t size = 0; size < text_.size(); size += 1 + size / 7)
        EXPECT_NE(message_of([&] { device_solver_of(text_.substr(0, size)); }), "") << size;
    // A byte that is changed may be one of a number: then it is another solver, or none.
    for (std::size_t at = 0; at < text_.size(); at += 3) {
        std::string changed = text_;
        changed[at] = static_cast<char>(changed[at] ^ 0x55);
        message_of([&] { device_solver_of(changed); });
    }
    std::string older = text_;
    older.insert(older.find('\n') + 1 + sizeof(std::uint64_t), "9");
    older[older.find('\n') + 1] += 1; // the length of the version
    EXPECT_THAT(message_of([&] { device_solver_of(older); }), HasSubstr("part of a yield of graze 9"));
}

} // namespace graze::yield_part_test
