#include "graze/base/input_error.hpp"
#include "graze/design/design_folder.hpp"
#include "graze/design/finished_design.hpp"
#include "graze/layout/verilog_a.hpp"
#include "graze/model/model_file.hpp"
#include "graze/picture/design_page.hpp"
#include "graze/picture/figure_script.hpp"
#include "program/commands.hpp"
#include "program/design_progress.hpp"
#include "program/drawing.hpp"
#include "program/interrupt.hpp"
#include "program/kept_inputs.hpp"
#include "program/mpi_workers.hpp"
#include "program/output_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze {

namespace {

int list_designs(const DesignArguments& arguments, const Console& console) {
    Table table({{"design", ""}, {"model", ""}, {"what it does", ""}});
    for (const std::string& name : shipped_designs()) {
        const Design design = load_design(name);
        table.add(name, design.model.name, design.text);
    }
    deliver(table, arguments.output, {}, console);
    return exit_success;
}

constexpr const char* circuit_module = "device.va";
constexpr const char* designed_results = "designed.sqlite"; ///< branch of the finished device up to its trip point

/// Removes the result file of the finished device of an earlier run, if it is a result file that nobody writes to.
void remove_designed_results(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        return;
    try {
        const ResultFile recognised(path, ResultFile::Access::read); // throws before the lock file is made beside it
        const ResultFile locked(path, ResultFile::Access::write);
        std::filesystem::remove(path, error);
    } catch (const InputError&) { // not a file of graze, or in use: keep it
    }
}

constexpr const char* report_name = "report.json";
constexpr const char* results_name = "results.sqlite"; ///< branch of the first device up to its trip point

/// True for a file with the name and the first line of a table that some runs write and others do not: it depends on
/// the dimensions, planes and wishes of the design.
bool is_table_of_a_run(const std::filesystem::path& path) {
    const std::string name = path.filename().string();
    const auto table_of = [&](const char* stem) { return name.starts_with(stem) && name.ends_with(".csv"); };
    std::string first;
    std::getline(std::ifstream(path), first);
    return (table_of("curve-") && first.ends_with(",class,problem")) ||
           (table_of("plane-") && first.ends_with(",class,problem")) ||
           (name == "tuning.csv" && first.ends_with(",usable,problem")) ||
           (name == "devices.csv" && first.starts_with("device,")) ||
           (name == "wishes.csv" && first.starts_with("what,")) ||
           (name == circuit_module && first.find("Written by graze") != std::string::npos);
}

/// The output folder of a design, with the list of files that this run has written.
class OutputFolder {
public:
    explicit OutputFolder(std::string folder) : folder_(std::move(folder)) {
        std::ifstream stream(std::filesystem::path(folder_) / report_name);
        std::string first(longest_start, ' ');
        stream.read(first.data(), static_cast<std::streamsize>(first.size()));
        used_ = first.find("\"graze\":") != std::string::npos; // the report of an earlier run
    }

    std::string path(const std::string& name) const {
        const std::string path = (std::filesystem::path(folder_) / name).string();
        require_inside(path, folder_);
        return path;
    }
    void write(const std::string& name, const std::string& text) {
        write_file(path(name), text);
        written_.push_back(path(name));
    }
    void draw(const Figure& figure, const std::string& name) {
        draw_figure(figure, path(name), "");
        written_.push_back(path(name));
    }
    /// Marks the folder as unfinished until finish(): files of an earlier run do not belong to this design.
    /// @throws InputError while another run works there
    void begin(const Design& design) const {
        const ResultFile locked(path(results_name), ResultFile::Access::write);
        write_file(path(unfinished_name), unfinished_text(design));
    }
    void finish() const {
        std::error_code error;
        std::filesystem::remove(path(unfinished_name), error);
    }
    /// Removes files of an earlier run that this run has not written: they do not belong to this design.
    void remove_others() const {
        std::error_code error;
        if (!designed_)
            remove_designed_results(path(designed_results));
        for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
            if (entry.is_regular_file(error) && is_of_a_run(entry.path()) &&
                std::none_of(written_.begin(), written_.end(), [&](const std::string& one) {
                    return std::filesystem::path(one).filename() == entry.path().filename();
                }))
                std::filesystem::remove(entry.path(), error);
        }
    }
    /// Path of the result file of the finished device.
    std::string designed() {
        designed_ = true;
        return path(designed_results);
    }
    const std::vector<std::string>& written() const { return written_; }

private:
    /// A page does not tell who wrote it: it counts as that of an earlier run if the folder has a report.
    bool is_of_a_run(const std::filesystem::path& path) const {
        const std::string name = path.filename().string();
        return (used_ && (name == "page.svg" || name == "page.pdf")) || is_table_of_a_run(path);
    }

    std::string folder_;
    std::vector<std::string> written_;
    static constexpr std::size_t longest_start = 100;
    bool designed_ = false;
    bool used_ = false; ///< the folder has the report of an earlier run
};

/// Prints the most frequent problems of devices of the yield.
void tell_yield_of_design(const Yield& yield, const Console& console) {
    constexpr std::size_t most = 5;
    for (std::size_t i = 0; i < std::min(most, yield.problems.size()); ++i)
        console.err << fmt::format("graze: {} of {} devices: {}\n", yield.problems[i].second, yield.made,
                                   yield.problems[i].first);
}

void write_all(OutputFolder& place, const FinishedDesign& finished, const DesignArguments& arguments,
               const Console& console) {
    const Design& design = finished.device;
    const TripPoint& trip = *finished.trip;
    const DesignReport& report = finished.report;
    const std::vector<NamedTable> tables = tables_of(design, trip, report);
    for (const NamedTable& table : tables)
        place.write(table.name + ".csv", csv_text(table.table));
    place.write(report_name, report_json(design, tables, GRAZE_VERSION));
    const Model device = model_of_device(trip);
    place.write(device_model_name, device_heading(finished.written) + write_model(device));
    if (has_verilog_a(device))
        place.write(circuit_module, verilog_a_text(device, design.name, "graze " GRAZE_VERSION));
    if (!arguments.no_pictures) {
        try {
            const Figure page = design_page(design, trip, report);
            place.draw(page, "page.svg");
            place.draw(page, "page.pdf");
        } catch (const InputError& error) {
            console.err << fmt::format("graze: warning: the page was not drawn: {}\n", error.what());
        }
    }
    place.remove_others();
    place.finish();
}

int interrupted(const Console& console) {
    console.err << fmt::format("graze: interrupted; nothing but the way to the trip point is kept, and {} says so of "
                               "what an earlier run has left\n",
                               unfinished_name);
    return InterruptGuard::exit_code();
}

int find_design(const DesignArguments& arguments, const Console& console, std::unique_ptr<Workers> workers) {
    const Design first = load_design(arguments.design);
    const std::string folder = arguments.folder.empty() ? first.name : arguments.folder;
    make_folder(folder, "--output");
    OutputFolder place(folder);
    keep_inputs_of(first);
    for (const char* name : {report_name, device_model_name, circuit_module, unfinished_name, "page.svg", "page.pdf"})
        KeptInputs::require_none_at(place.path(name)); // before the computation
    place.begin(first);
    const InterruptGuard guard;
    StatusLine line(console, console.terminal);
    DesignReportOptions options = interactive_options(arguments.jobs, line, workers.get());
    FinishedDesign finished;
    carry_out(workers.get(), [&](const std::function<bool()>& must_stop) {
        options.interrupted = must_stop;
        finished = finish_design(first, {place.path(results_name), [&] { return place.designed(); }}, options);
    });
    workers.reset(); // the rest is for one process
    if (finished.interrupted)
        return interrupted(console);
    write_all(place, finished, arguments, console);
    const DesignReport& report = finished.report;
    if (!arguments.quiet) {
        deliver(facts_of(finished.device, *finished.trip, report), arguments.output, {}, console);
        if (arguments.output.format == TableFormat::table)
            for (const std::string& path : place.written())
                console.out << path << '\n';
    }
    if (report.yield)
        tell_yield_of_design(*report.yield, console);
    if (finished.is_untried())
        console.err << fmt::format("graze: the class is not checked by simulation: {}\n", report.trial.reason);
    if (finished.trips_elsewhere())
        console.err << fmt::format(
            "graze: the device was made to trip at {:.6g}, but on its way there it comes first to the "
            "trip point at {:.6g}: change approach.range, approach.from or what is wanted\n",
            *report.wishes->trip_value, finished.trip->value());
    return finished.warnings().empty() ? exit_success : exit_irregular;
}

} // namespace

int design_command(const DesignArguments& arguments, const Console& console) {
    if (arguments.list)
        return list_designs(arguments, console);
    if (arguments.design.empty())
        throw InputError("no design is named", "graze design --list names those that come with graze");
    if (arguments.show) {
        console.out << shipped_design_text(arguments.design);
        return exit_success;
    }
    return with_workers(arguments.jobs, [&](std::unique_ptr<Workers> workers) {
        return find_design(arguments, console, std::move(workers));
    });
}

} // namespace graze
