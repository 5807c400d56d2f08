#include "python/parts.hpp"

#include "graze/base/require.hpp"
#include "python/attended.hpp"

#include <chrono>

namespace graze::python {

namespace {

constexpr std::chrono::milliseconds between_looks{20};

bool is_complete(std::span<const ChainProgress> known, std::size_t chain, std::size_t chain_length) {
    return chain < known.size() && known[chain].done >= chain_length;
}

/// Chains that are not complete, in ranges.
std::vector<ChainRange> missing_chains(const PartedRun& run, std::span<const ChainProgress> known) {
    std::vector<ChainRange> ranges;
    for (std::size_t chain = 0; chain < run.chains(); ++chain) {
        if (is_complete(known, chain, run.chain_length()))
            continue;
        if (ranges.empty() || ranges.back().last != chain)
            ranges.push_back({chain, chain});
        ranges.back().last = chain + 1;
    }
    return ranges;
}

py::bytes computed(const PartedRun& run, const std::string& part) {
    std::string points;
    const RunPart asked = part_of(part);
    attended([&](const std::function<bool()>& must_stop) { points = computed_points(run, asked, must_stop); });
    return points;
}

} // namespace

bool PartExchange::await(const PartedRun& run, std::span<const ChainProgress> known,
                         const std::function<bool()>& interrupted, const PointSink& sink) {
    std::size_t missing = 0;
    for (const ChainRange& range : missing_chains(run, known))
        missing += range.size();
    if (missing == 0)
        return true;
    std::unique_lock lock(mutex_);
    const std::size_t number = next_++;
    Open& open = open_[number]; // stays where it is while others come and go
    open.run = &run;
    open.known = known;
    open.missing = missing;
    const auto close = [&] {
        if (!lock.owns_lock())
            lock.lock();
        open_.erase(number);
    };
    try {
        // What has been given is kept even if the run is interrupted.
        while (open.missing > 0 || !open.given.empty()) {
            if (!open.given.empty()) {
                const auto [part, points] = std::move(open.given.front());
                open.given.pop_front();
                lock.unlock();
                read_points(run, part, points, sink);
                lock.lock();
                continue;
            }
            if (open.failure)
                throw InputError(*open.failure);
            if (interrupted && interrupted())
                break;
            changed_.wait_for(lock, between_looks);
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
        for (const ChainRange& range : missing_chains(*open.run, open.known))
            ranges.append(py::make_tuple(range.first, range.last));
        list.append(py::make_tuple(number, py::bytes(open.run->text()), ranges));
    }
    return list;
}

py::bytes PartExchange::part(std::size_t number, std::size_t first, std::size_t last) const {
    const std::lock_guard lock(mutex_);
    const auto found = open_.find(number);
    if (found == open_.end())
        return {};
    require_room(found->second.run->chains(), last, "chains of a part");
    require_room(last, first, "chains before a part");
    RunPart part{{first, last}, {}};
    const std::span<const ChainProgress> all = found->second.known;
    const auto known = all.empty() ? all : all.subspan(first, last - first);
    if (std::ranges::any_of(known, [](const ChainProgress& chain) { return chain.done > 0; }))
        part.known.assign(known.begin(), known.end());
    return bytes_of(part);
}

void PartExchange::give(std::size_t number, const std::string& part, std::string points) {
    RunPart given = part_of(part);
    const std::lock_guard lock(mutex_);
    const auto found = open_.find(number);
    if (found == open_.end())
        return;
    require_room(found->second.missing, given.chains.size(), "missing chains");
    found->second.missing -= given.chains.size();
    found->second.given.emplace_back(std::move(given), std::move(points));
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

void bind_parts(py::module_& module) {
    py::class_<PartedRun, std::shared_ptr<PartedRun>>(module, "PartedRun")
        .def(py::init([](const std::string& text) {
                 const py::gil_scoped_release unlocked;
                 return std::make_shared<PartedRun>(text);
             }),
             py::arg("text"))
        .def("computed", &computed, py::arg("part"));
    py::class_<PartExchange, std::shared_ptr<PartExchange>>(module, "PartExchange")
        .def(py::init())
        .def("opened", &PartExchange::opened)
        .def("part", &PartExchange::part, py::arg("number"), py::arg("first"), py::arg("last"))
        .def("give", &PartExchange::give, py::arg("number"), py::arg("part"), py::arg("points"))
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
