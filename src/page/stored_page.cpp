#include "page/stored_page.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/rounded.hpp"
#include "graze/picture/result_picture.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/results/run_kind.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/study/stored_study.hpp"
#include "page/figure_json.hpp"
#include "page/json_text.hpp"
#include "page/model_json.hpp"
#include "page/motion_json.hpp"
#include "page/motion_rows.hpp"
#include "page/pictures_json.hpp"
#include "page/point_json.hpp"
#include "page/runs_json.hpp"
#include "page/special_points_json.hpp"
#include "page/stored_point.hpp"
#include "page/table_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>

namespace graze {

namespace {

constexpr std::size_t rows_of_motion = 400;
constexpr std::size_t most_points_of_branch = 400, most_points_of_motions = 40;
constexpr std::size_t most_steps_of_motion = 200'000;

/// Names and expressions that the page shows of a motion: states, quantities, and what the drawing needs.
std::vector<std::string> shown_of_motion(const Model& model) {
    std::vector<std::string> names;
    const auto add = [&](const std::string& name) {
        char* end = nullptr;
        std::strtod(name.c_str(), &end); // a number needs no column
        if (!name.empty() && *end != '\0' && std::ranges::find(names, name) == names.end())
            names.push_back(name);
    };
    for (const State& state : model.states)
        add(state.name);
    for (const Quantity& quantity : model.quantities)
        add(quantity.name);
    if (model.drawing)
        for (const DrawnShape& shape : model.drawing->shapes) {
            for (const DrawnPair& point : shape.points) {
                add(point.x);
                add(point.y);
            }
            add(shape.size.x);
            add(shape.size.y);
            add(shape.radius);
        }
    return names;
}

constexpr int digits_seen = 6; ///< of numbers

/// Leaves out rows of a motion and digits of its numbers, so that more motions have room.
void shorten_motion(nlohmann::json& motion) {
    DenseMotion rows;
    for (const nlohmann::json& column : motion.at("values")) {
        std::vector<double>& values = rows.values.emplace_back();
        for (const nlohmann::json& value : column)
            values.push_back(value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN());
    }
    rows.begins = motion.at("begins").get<decltype(rows.begins)>();
    rows.impacts = motion.at("contacts").get<decltype(rows.impacts)>();
    thin_rows(rows, rows_of_motion);
    nlohmann::json values = nlohmann::json::array();
    for (std::vector<double>& column : rows.values) {
        std::ranges::transform(column, column.begin(), [](double value) { return rounded(value, digits_seen); });
        values.push_back(numbers_json(column));
    }
    motion["values"] = std::move(values);
    motion["begins"] = rows.begins;
    motion["contacts"] = rows.impacts;
}

/// The numbers below `count` in an order in which any first ones are spread evenly.
std::vector<std::size_t> spread_numbers(std::size_t count) {
    std::vector<std::size_t> result;
    std::size_t step = 1;
    while (step < count)
        step *= 2;
    if (count > 0)
        result.push_back(0);
    for (; step >= 2; step /= 2)
        for (std::size_t number = step / 2; number < count; number += step)
            result.push_back(number);
    return result;
}

/// Members of a JSON object, written one after the other.
class ObjectText {
public:
    void add(const std::string& key, const std::string& value) {
        text_ += (text_.empty() ? "" : ",\n") + json_text(key) + ":" + value;
    }
    std::size_t size() const { return text_.size(); }
    std::string text() const { return "{" + text_ + "}"; }

private:
    std::string text_;
};

/// Collects the data of one page.
class StoredPage {
public:
    StoredPage(const ResultFile& file, const PageFileOptions& options)
        : file_(file), options_(options), study_(stored_study(file)) {
        choose_runs();
    }

    std::string text() {
        const std::string title = !options_.title.empty() ? options_.title
                                  : study_.name.empty()   ? "results"
                                                          : study_.name;
        nlohmann::json session{{"version", GRAZE_VERSION}, {"title", title}, {"can_compute", false}};
        session["opened"] = {{"kind", "results"}, {"name", title}};
        session["results"] = session["stored"] = true;
        page_.add("session", json_text(session));
        add_runs();
        add_figures();
        add_points();
        return page_.text();
    }

private:
    void choose_runs() {
        std::vector<std::string> all;
        for (const RunRecord& run : file_.runs())
            all.push_back(run.name);
        for (const std::string& name : options_.runs)
            if (std::ranges::find(all, name) == all.end())
                throw InputError(fmt::format("there is no run '{}' in the results", name),
                                 name_advice(name, all, "there are none"));
        for (const std::string& name : all)
            if (options_.runs.empty() || std::ranges::find(options_.runs, name) != options_.runs.end())
                runs_.emplace_back(file_, name, Place{});
    }

    bool is_shown(const std::string& name) const {
        return std::ranges::any_of(runs_, [&](const StoredRun& run) { return run.record.name == name; });
    }

    void add_runs() {
        nlohmann::json runs = runs_json(file_, nullptr);
        std::erase_if(runs.get_ref<nlohmann::json::array_t&>(),
                      [&](const nlohmann::json& run) { return !is_shown(run.at("name").get<std::string>()); });
        page_.add("runs", json_text(runs));
        ObjectText models, special;
        for (const StoredRun& run : runs_) {
            models.add(run.record.name, json_text(model_json(run.model)));
            special.add(run.record.name, json_text(special_points_json(run).at("rows")));
        }
        page_.add("models", models.text());
        page_.add("special_points", special.text());
    }

    /// Pictures that were asked for, those of the study, and one of each run and of all branches together.
    void add_figures() {
        std::vector<StudyPicture> named = options_.pictures;
        for (const StudyPicture& one : study_.pictures)
            if (std::ranges::all_of(one.runs, [&](const std::string& run) { return is_shown(run); }) &&
                std::ranges::find(named, one.name, &StudyPicture::name) == named.end())
                named.push_back(one);
        Study listed;
        for (const StudyPicture& one : named)
            if (add_figure(one.name, one, !is_asked_for(one)))
                listed.pictures.push_back(one);
        StudyPicture branches;
        for (const StoredRun& stored : runs_) {
            const RunRecord& run = stored.record;
            if (file_.point_count(run.name) == 0)
                continue;
            add_figure({{"runs", {run.name}}}, default_picture(run), true);
            if (run.is_followed() && run.kind != name_of(RunKind::curve)) {
                if (branches.runs.empty())
                    branches = default_picture(run);
                else
                    branches.runs.push_back(run.name);
            }
        }
        if (branches.runs.size() > 1)
            add_figure({{"runs", branches.runs}}, branches, true);
        page_.add("figures", json_text(figures_));
        page_.add("pictures", json_text(pictures_json(listed)));
    }

    bool is_asked_for(const StudyPicture& one) const {
        return std::ranges::find(options_.pictures, one.name, &StudyPicture::name) != options_.pictures.end();
    }

    /// @param may_fail whether a picture that cannot be made is left out, as one of a run without points
    bool add_figure(const nlohmann::json& key, const StudyPicture& picture, bool may_fail) {
        try {
            const ResultPicture made = make_picture(picture, file_);
            nlohmann::json answer{{"figure", figure_json(made.figure)}};
            answer["table"] = made.table.rows() > 0 ? table_json("", made.table) : nlohmann::json();
            figures_.push_back({{"key", key}, {"answer", std::move(answer)}});
            return true;
        } catch (const InputError&) {
            if (!may_fail)
                throw;
            return false;
        }
    }

    /// Special points of all runs come first, then others of all runs in turn.
    void add_points() {
        std::vector<std::vector<std::size_t>> numbers;
        for (const StoredRun& run : runs_)
            numbers.push_back(numbers_of(run.record));
        std::size_t most = 0;
        for (const std::vector<std::size_t>& one : numbers)
            most = std::max(most, one.size());
        bool room = true;
        for (std::size_t run = 0; run < runs_.size(); ++run)
            for (std::size_t i = 0; i < special_[run] && room; ++i)
                room = add_point(runs_[run], numbers[run][i]);
        for (std::size_t i = 0; i < most && room; ++i)
            for (std::size_t run = 0; run < runs_.size() && room; ++run)
                if (special_[run] + i < numbers[run].size())
                    room = add_point(runs_[run], numbers[run][special_[run] + i]);
        page_.add("points", points_.text());
        page_.add("motions", motions_.text());
    }

    std::vector<std::size_t> numbers_of(const RunRecord& run) {
        std::vector<std::size_t> numbers;
        if (run.is_branch())
            for (const OrbitRecord& orbit : file_.orbits(run.name, true))
                numbers.push_back(orbit.number);
        special_.push_back(numbers.size());
        const std::set<std::size_t> known(numbers.begin(), numbers.end());
        const std::size_t most = run.is_branch() ? most_points_of_branch : most_points_of_motions;
        for (const std::size_t number : spread_numbers(file_.point_count(run.name)))
            if (!known.contains(number) && numbers.size() < special_.back() + most)
                numbers.push_back(number);
        return numbers;
    }

    /// @return whether there was room
    bool add_point(const StoredRun& run, std::size_t number) {
        const std::string key = fmt::format("{}/{}", run.record.name, number);
        nlohmann::json point = point_json(run, number);
        point["actions"] = nlohmann::json::array(); // nothing can be computed
        const std::string text = json_text(point), motion = motion_text(run, number);
        if (page_.size() + points_.size() + motions_.size() + text.size() + motion.size() > options_.most_bytes)
            return false;
        points_.add(key, text);
        if (!motion.empty())
            motions_.add(key, motion);
        return true;
    }

    /// Empty: it cannot be computed.
    static std::string motion_text(const StoredRun& run, std::size_t number) {
        try {
            std::size_t steps = 0; // instead of a time, so that the same results make the same page
            nlohmann::json motion = motion_json(
                run, number, is_measured_run(run.record) ? std::vector<std::string>() : shown_of_motion(run.model),
                [&] { return ++steps > most_steps_of_motion; });
            shorten_motion(motion);
            return json_text(motion);
        } catch (const InputError&) {
            return "";
        }
    }

    const ResultFile& file_;
    const PageFileOptions& options_;
    Study study_;
    std::vector<StoredRun> runs_;
    std::vector<std::size_t> special_; ///< number of special points of each run
    nlohmann::json figures_ = nlohmann::json::array();
    ObjectText page_, points_, motions_;
};

} // namespace

std::string stored_page(const ResultFile& file, const PageFileOptions& options) {
    return StoredPage(file, options).text();
}

} // namespace graze
