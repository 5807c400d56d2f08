#include "python/parts.hpp"

#include "graze/base/require.hpp"
#include "graze/layout/wafer_yield.hpp"
#include "python/attended.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

namespace graze::python {

namespace {

constexpr std::chrono::milliseconds between_answers{20};

/// Chains that are not complete, in ranges.
std::vector<ItemRange> missing_chains(const PartedRun& run, std::span<const ChainProgress> known) {
    std::vector<ItemRange> ranges;
    for (std::size_t chain = 0; chain < run.chains(); ++chain) {
        if (chain < known.size() && known[chain].done >= run.chain_length())
            continue;
        if (ranges.empty() || ranges.back().last != chain)
            ranges.push_back({chain, chain});
        ranges.back().last = chain + 1;
    }
    return ranges;
}

/// Chains, and what of each is there.
RunPart run_part(ItemRange chains, std::span<const ChainProgress> known) {
    RunPart part{chains, {}};
    if (!known.empty())
        known = known.subspan(chains.first, chains.size());
    if (std::ranges::any_of(known, [](const ChainProgress& chain) { return chain.done > 0; }))
        part.known.assign(known.begin(), known.end());
    return part;
}

/// What a worker needs in order to compute parts of some work: it is made of the text of PartedWork.
class PartWorker {
public:
    explicit PartWorker(const std::string& text) {
        if (is_device_solver(text))
            computed_ = [solver = std::make_shared<const DeviceSolver>(device_solver_of(text, wafer_examination_of))](
                            const std::string& part, const std::function<bool()>& must_stop) {
                return solved_part(*solver, part, must_stop);
            };
        else
            computed_ = [run = std::make_shared<const PartedRun>(text)](const std::string& part,
                                                                        const std::function<bool()>& must_stop) {
                return computed_points(*run, part_of(part), must_stop);
            };
    }
    py::bytes computed(const std::string& part) const {
        std::string result;
        attended([&](const std::function<bool()>& must_stop) { result = computed_(part, must_stop); });
        return result;
    }

private:
    std::function<std::string(const std::string& part, const std::function<bool()>& must_stop)> computed_;
};

} // namespace

bool PartExchange::await(const PartedWork& work, const std::function<bool()>& interrupted) {
    std::size_t missing = 0;
    for (const ItemRange& range : work.missing)
        missing += range.size();
    if (missing == 0)
        return true;
    std::unique_lock lock(mutex_);
    const std::size_t number = next_++;
    Open& open = open_[number]; // stays where it is while others come and go
    open.work = &work;
    open.missing = missing;
    const auto close = [&] {
        if (!lock.owns_lock())
            lock.lock();
        open_.erase(number);
    };
    try {
        // What has been given is kept even if the work is interrupted.
        while (open.missing > 0 || !open.given.empty()) {
            if (!open.given.empty()) {
                const auto [range, result] = std::move(open.given.front());
                open.given.pop_front();
                lock.unlock();
                work.take(range, result);
                lock.lock();
                continue;
            }
            if (open.failure)
                throw InputError(*open.failure);
            if (interrupted && interrupted())
                break;
            changed_.wait_for(lock, between_answers);
        }
        const bool complete = open.missing == 0;
        close();
        return complete;
    } catch (...) {
        close();
        throw;
    }
}

py::list PartExchange::opened() {
    py::list list;
    const std::lock_guard lock(mutex_);
    for (auto& [number, open] : open_) {
        if (open.is_told)
            continue;
        open.is_told = true;
        py::list ranges;
        for (const ItemRange& range : open.work->missing)
            ranges.append(py::make_tuple(range.first, range.last));
        list.append(py::make_tuple(number, py::bytes(open.work->text), ranges));
    }
    return list;
}

py::bytes PartExchange::part(std::size_t number, std::size_t first, std::size_t last) const {
    const std::lock_guard lock(mutex_);
    const auto found = open_.find(number);
    if (found == open_.end())
        return {};
    require_room(last, first, "items before a part");
    require_room(found->second.work->missing.back().last, last, "items of a part");
    return found->second.work->part({first, last});
}

void PartExchange::give(std::size_t number, std::size_t first, std::size_t last, std::string result) {
    const std::lock_guard lock(mutex_);
    const auto found = open_.find(number);
    if (found == open_.end())
        return;
    require_room(last, first, "items before a part");
    require_room(found->second.missing, last - first, "missing items");
    found->second.missing -= last - first;
    found->second.given.emplace_back(ItemRange{first, last}, std::move(result));
    changed_.notify_all();
}

void PartExchange::fail(std::size_t number, const InputError& error) {
    const std::lock_guard lock(mutex_);
    const auto found = open_.find(number);
    if (found == open_.end())
        return;
    found->second.failure = error;
    changed_.notify_all();
}

PointsElsewhere points_by(const std::shared_ptr<PartExchange>& parts) {
    if (!parts)
        return {};
    return [parts](const PartedRun& run, std::span<const ChainProgress> known, const std::function<bool()>& interrupted,
                   const PointSink& sink) {
        const auto take = [&](ItemRange chains, const std::string& points) {
            read_points(run, run_part(chains, known), points, sink);
        };
        return parts->await({run.text(), missing_chains(run, known),
                             [&](ItemRange chains) { return bytes_of(run_part(chains, known)); }, take},
                            interrupted);
    };
}

DevicesElsewhere devices_by(const std::shared_ptr<PartExchange>& parts) {
    if (!parts)
        return {};
    return [parts](const AskedDevices& devices, const std::function<bool()>& interrupted, const DeviceSink& sink) {
        const auto take = [&](ItemRange range, const std::string& solved) {
            read_devices(devices, range, solved, sink);
        };
        return parts->await({bytes_of(devices.solver),
                             {{0, devices.count}},
                             [&](ItemRange range) { return part_of(devices, range); },
                             take},
                            interrupted);
    };
}

void bind_parts(py::module_& module) {
    py::class_<PartWorker, std::shared_ptr<PartWorker>>(module, "PartWorker")
        .def(py::init([](const std::string& text) {
                 const Unlocked unlocked;
                 return std::make_shared<PartWorker>(text);
             }),
             py::arg("text"))
        .def("computed", &PartWorker::computed, py::arg("part"));
    py::class_<PartExchange, std::shared_ptr<PartExchange>>(module, "PartExchange")
        .def(py::init())
        .def("opened", &PartExchange::opened)
        .def("part", &PartExchange::part, py::arg("number"), py::arg("first"), py::arg("last"))
        .def("give", &PartExchange::give, py::arg("number"), py::arg("first"), py::arg("last"), py::arg("result"))
        .def(
            "fail",
            [](PartExchange& self, std::size_t number, const std::string& problem, const std::string& remedy,
               const std::string& file, int line, int column) {
                self.fail(number, InputError(Place{file, line, column}, problem, remedy));
            },
            py::arg("number"), py::arg("problem"), py::arg("remedy"), py::arg("file"), py::arg("line"),
            py::arg("column"))
        // How many motions one core computes at once at best.
        .def_property_readonly_static(
            "together", [](const py::object&) { return 2 * lanes_of(LaneKind::ensemble, best_instruction_set()); });
}

} // namespace graze::python
