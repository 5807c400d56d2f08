#include "python/binding.hpp"

#include "graze/layout/wafer_yield.hpp"
#include "graze/study/part_computer.hpp"
#include "graze/study/part_exchange.hpp"
#include "graze/study/part_sizes.hpp"
#include "python/attended.hpp"

#include <exception>
#include <memory>
#include <utility>
#include <vector>

namespace graze::python {

namespace {

/// What a worker needs in order to compute parts of some work: it is made of the text of PartedWork.
class PartWorker {
public:
    explicit PartWorker(const std::string& text) : computation_(computation_of(text, wafer_examination_of)) {}
    py::bytes computed(const std::string& part) const {
        std::string result;
        attended([&](const std::function<bool()>& must_stop) { result = computation_(part, must_stop, {}); });
        return result;
    }

private:
    PartComputation computation_;
};

py::list opened_by(PartExchange& exchange) {
    py::list list;
    for (const PartExchange::Opened& work : exchange.opened()) {
        py::list ranges;
        for (const ItemRange& range : work.missing)
            ranges.append(py::make_tuple(range.first, range.last));
        list.append(py::make_tuple(work.number, py::bytes(work.text), ranges));
    }
    return list;
}

} // namespace

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
        .def("opened", &opened_by)
        .def(
            "part",
            [](const PartExchange& self, std::size_t number, std::size_t first, std::size_t last) {
                return py::bytes(self.part(number, {first, last}).value_or(""));
            },
            py::arg("number"), py::arg("first"), py::arg("last"))
        .def(
            "give",
            [](PartExchange& self, std::size_t number, std::size_t first, std::size_t last, std::string result) {
                self.give(number, {first, last}, std::move(result));
            },
            py::arg("number"), py::arg("first"), py::arg("last"), py::arg("result"))
        .def(
            "fail",
            [](PartExchange& self, std::size_t number, const std::string& problem, const std::string& remedy,
               const std::string& file, int line, int column) {
                self.fail(number, std::make_exception_ptr(InputError(Place{file, line, column}, problem, remedy)));
            },
            py::arg("number"), py::arg("problem"), py::arg("remedy"), py::arg("file"), py::arg("line"),
            py::arg("column"));
    py::class_<PartSizes>(module, "PartSizes")
        .def(py::init([](const std::vector<std::pair<std::size_t, std::size_t>>& missing) {
                 std::vector<ItemRange> ranges;
                 for (const auto& [first, last] : missing)
                     ranges.push_back({first, last});
                 return PartSizes(ranges);
             }),
             py::arg("missing"))
        .def_property_readonly("has_more", &PartSizes::has_more)
        .def(
            "cut",
            [](PartSizes& self, std::size_t workers) {
                const ItemRange part = self.cut(workers);
                return py::make_tuple(part.first, part.last);
            },
            py::arg("workers"))
        .def("note", &PartSizes::note, py::arg("items"), py::arg("seconds"));
}

} // namespace graze::python
