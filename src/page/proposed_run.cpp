#include "page/proposed_run.hpp"

#include "base/letter_case.hpp"
#include "graze/base/file_name.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/printable.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/study/plain_states.hpp"
#include "graze/study/study_keys.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/model_file_toml.hpp"
#include "model/model_validate.hpp"
#include "model/written_text.hpp"
#include "results/schema.hpp"
#include "study/study_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

namespace graze {

namespace {

/// The text of one proposed run, key by key.
class RunProposal {
public:
    RunProposal(const PointOrigin& origin, const Study& study, const ResultFile* file, const ProposalWish& wish)
        : origin_(origin), study_(study), file_(file), wish_(wish), action_(wished_action()) {}

    ProposedRun propose() {
        choose_parameters();
        add_model();
        if (action_.name == "simulate")
            propose_motion();
        else if (action_.name == "sweep")
            propose_sweep();
        else if (action_.name == "orbit")
            propose_orbit();
        else if (action_.name == "equilibrium")
            propose_equilibrium();
        else
            propose_branch();
        for (const auto& [key, value] : wish_.options)
            add_option(key, value);
        ProposedRun result{free_name(), {}};
        result.text = fmt::format("[runs.{}]\n", toml_key(result.name));
        for (const auto& [key, value] : keys_)
            result.text += fmt::format("{} = {}\n", key, value);
        return result;
    }

private:
    PointAction wished_action() const {
        const std::vector<PointAction> known = actions_at(origin_);
        // "switch" is what leads to another branch, also where it has a name of its own.
        const auto found = std::ranges::find_if(known, [&](const PointAction& one) {
            return one.name == wish_.action || (wish_.action == "switch" && one.name == "double");
        });
        if (found != known.end())
            return *found;
        std::vector<std::string> names;
        for (const PointAction& one : known)
            names.push_back(one.name);
        throw InputError(fmt::format("'{}' is not possible {}", wish_.action,
                                     origin_.run.empty() ? "without results" : "from " + origin_.name()),
                         names.empty() ? "choose another point"
                                       : fmt::format("choose from {}", fmt::join(names, ", ")));
    }

    void add(const std::string& key, std::string value) { keys_.emplace_back(key, std::move(value)); }

    void add_kind(RunKind kind) {
        kind_ = kind;
        add("kind", toml_string(std::string(name_of(kind))));
    }

    void add_option(const std::string& key, const std::string& value) {
        if (key == "kind")
            throw InputError(
                fmt::format("'{}' makes a run of kind {}: the action decides the kind", action_.name, name_of(kind_)),
                "leave 'kind' out, or choose another action");
        const std::vector<std::string> known = names_of(study_keys(kind_));
        if (std::ranges::find(known, key) == known.end())
            throw InputError(
                fmt::format("'{}' is no key of a run of kind {}", printable_line(shortened(key, 100)), name_of(kind_)),
                name_advice(key, known, ""));
        if (value.find_first_of("\r\n") != std::string::npos)
            throw InputError(fmt::format("the value of '{}' has several lines", key), "write it in one");
        const auto found = std::ranges::find(keys_, key, &std::pair<std::string, std::string>::first);
        if (found != keys_.end())
            found->second = value;
        else
            add(key, value);
    }

    /// Replaces proposed parameters and bounds by those that are wished.
    void choose_parameters() {
        if (wish_.along.size() > action_.along.size())
            throw InputError(fmt::format("'{}' goes along {} parameters, not {}", action_.name, action_.along.size(),
                                         wish_.along.size()),
                             action_.along.empty() ? "leave them out" : "leave some out");
        for (std::size_t i = 0; i < wish_.along.size(); ++i)
            choose_parameter(i, wish_.along[i]);
        std::set<std::string> used;
        for (AlongParameter& one : action_.along) {
            if (!used.insert(one.name).second)
                throw InputError(fmt::format("the parameter '{}' is named twice", one.name), "name two different ones");
            if (const auto found = wish_.bounds.find(one.name); found != wish_.bounds.end())
                std::tie(one.least, one.greatest) = found->second;
            if (!std::isfinite(one.least) || !std::isfinite(one.greatest) || !(one.least < one.greatest))
                throw InputError(fmt::format("'{}' goes from {} to {}", one.name, one.least, one.greatest),
                                 "give the lower bound first, then a greater one");
        }
        for (const auto& [name, bounds] : wish_.bounds)
            if (!used.contains(name))
                throw InputError(fmt::format("'{}' has bounds, but nothing goes along it", name),
                                 name_remedy(name, origin_.model.independent_parameters()));
    }

    void choose_parameter(std::size_t i, const std::string& name) {
        origin_.model.independent_parameter(name); // refuses unknown ones
        const auto known = std::ranges::find(action_.along, name, &AlongParameter::name);
        const auto place = static_cast<std::size_t>(known - action_.along.begin());
        if (place >= wish_.along.size() && known != action_.along.end()) {
            std::swap(*known, action_.along[i]); // what is not wished otherwise gives way
        } else if (place != i) {
            const std::vector<AlongParameter> all = proposed_parameters(origin_);
            action_.along[i] = *std::ranges::find(all, name, &AlongParameter::name);
        }
    }

    void add_model() {
        std::string model = origin_.asked.model.name;
        if (model.empty())
            model = wish_.study_model.empty() ? origin_.model.name : wish_.study_model;
        if (!origin_.asked.model_path.empty()) {
            const std::filesystem::path path = origin_.asked.model_path,
                                        folder = std::filesystem::path(study_.file).parent_path();
            const bool beside = path.is_absolute() == folder.is_absolute() && !folder.empty();
            model = (beside ? path.lexically_relative(folder) : path).string();
            if (!is_model_path(model))
                model = "./" + model;
        }
        const auto plain = [](const std::string& path) {
            return std::filesystem::path(path).lexically_normal().string();
        };
        if (wish_.study_model.empty() || plain(model) != plain(wish_.study_model))
            add("model", toml_string(model));
    }

    void add_start() {
        if (origin_.run.empty())
            return;
        const std::string name = origin_.name();
        const bool is_number = name.find_first_not_of("0123456789") == std::string::npos;
        std::string start =
            fmt::format("run = {}, point = {}", toml_string(origin_.run), is_number ? name : toml_string(name));
        if (!action_.onto.empty())
            start += fmt::format(", onto = {}", toml_string(action_.onto));
        add("start", fmt::format("{{ {} }}", start));
    }

    std::string along_text() const {
        std::vector<std::string> parts;
        for (const AlongParameter& one : action_.along)
            parts.push_back(fmt::format("{} = [{}, {}]", one.name, number_text(one.least), number_text(one.greatest)));
        return fmt::format("{{ {} }}", fmt::join(parts, ", "));
    }

    /// The section whose passages the origin counts, if a run would count those of another one.
    void add_section() {
        if (origin_.run.empty() || (!origin_.asked.has_motions() && !origin_.asked.is_branch()))
            return;
        const std::string& section = origin_.asked.attractor().section;
        if (!section.empty() && section != usual_section(origin_.model))
            add("section", toml_string(section));
    }

    void propose_motion() {
        add_kind(RunKind::simulate);
        add_start();
        if (origin_.model.sections.empty()) {
            add("time", "100");
            return;
        }
        add_section();
        add("periods", "50");
    }

    void propose_sweep() {
        constexpr int points = 201;
        add_kind(RunKind::sweep);
        add_start();
        const AlongParameter& swept = action_.along.front();
        add("vary", fmt::format("{{ {} = {{ from = {}, to = {}, points = {} }} }}", swept.name,
                                number_text(swept.least), number_text(swept.greatest), points));
        add_section();
    }

    void propose_orbit() {
        add_kind(RunKind::orbit);
        add_start();
        add_section();
        add_period();
    }

    void propose_equilibrium() {
        add_kind(RunKind::equilibrium);
        add_start();
    }

    /// A period that is longer than those that are searched for.
    void add_period() {
        const std::size_t period = origin_.point ? origin_.point->result.period : 0;
        if (period > AttractorOptions().largest_period)
            add("largest_period", fmt::format("{}", period));
    }

    void propose_branch() {
        const bool curve = action_.name.starts_with("curve");
        add_kind(curve ? RunKind::curve : action_.name == "ladder" ? RunKind::ladder : RunKind::follow);
        add_start();
        add("along", along_text());
        if (origin_.point) {
            add_section();
            add_period();
        }
        if (origin_.orbit)
            add_monitors();
    }

    /// The monitors of the run, so that one picture can show both. Those that are held, or that belong to a segment of
    /// an orbit with other contacts, stay behind.
    void add_monitors() {
        const bool other_contacts =
            (origin_.type() == PointType::grazing && (action_.onto == "other" || action_.name == "ladder")) ||
            (origin_.type() == PointType::hopf && action_.onto == "other");
        std::vector<std::string> parts;
        bool usual = true;
        const std::vector<Monitor>& all = origin_.asked.branch().settings.monitors;
        for (const Monitor& one : all) {
            usual = usual && is_usual(one);
            if (!one.fixed && (one.segment.empty() || !other_contacts))
                parts.push_back(fmt::format("{} = {}", toml_key(one.name), monitor_text(one)));
        }
        if (!usual && !parts.empty())
            add("monitors", fmt::format("{{ {} }}", fmt::join(parts, ", ")));
    }

    bool is_usual(const Monitor& one) const {
        if (!one.segment.empty() || one.fixed)
            return false;
        if (one.kind == Monitor::Kind::duration)
            return one.name == "period";
        if (one.kind == Monitor::Kind::conserved)
            return find_named(origin_.model.conserved, one.name).has_value();
        return one.kind == Monitor::Kind::maximum && one.name == "max_" + to_string(one.expression);
    }

    static std::string monitor_text(const Monitor& one) {
        const bool number = one.segment.find_first_not_of("0123456789") == std::string::npos;
        const std::string segment = number ? one.segment : toml_string(one.segment);
        if (one.kind == Monitor::Kind::duration)
            return one.segment.empty() ? "\"period\"" : fmt::format("{{ duration = {} }}", segment);
        if (one.kind == Monitor::Kind::multiplier)
            return fmt::format("{{ multiplier = {} }}", one.place);
        if (one.kind == Monitor::Kind::conserved)
            return fmt::format("{{ conserved = {} }}", toml_string(one.name));
        return fmt::format("{{ {} = {}{} }}", monitor_kinds().at(static_cast<std::size_t>(one.kind)),
                           value_of_written(written_text(one.expression)),
                           one.segment.empty() ? "" : fmt::format(", at = {}", segment));
    }

    /// A name that says where the run comes from and what it is.
    std::string free_name() const {
        constexpr std::size_t longest = 80; // leaves room for a number
        std::string name = action_.name;
        if (!origin_.run.empty()) {
            const std::string point = origin_.is_of(RunKind::orbit) ? "" : "-" + origin_.name();
            const bool parameter = action_.name == "another" || action_.name == "follow" || action_.name == "sweep";
            name = fmt::format("{}{}-{}{}", origin_.run, point, action_.name == "another" ? "along" : action_.name,
                               parameter ? "-" + action_.along.front().name : "");
        }
        if (name.size() > longest)
            name.resize(longest);
        std::ranges::replace(name, '.', '-');  // "map.b12" and what begins so are names that an atlas gives
        std::set<std::string> taken{"points"}; // a view of result files
        for (const StudyRun& run : study_.runs)
            taken.insert(in_small_letters(run.name));
        if (file_ != nullptr)
            for (const RunRecord& run : file_->runs())
                taken.insert(in_small_letters(run.name));
        return distinct_name(name, taken);
    }

    const PointOrigin& origin_;
    const Study& study_;
    const ResultFile* file_;
    const ProposalWish& wish_;
    PointAction action_;
    RunKind kind_ = RunKind::simulate;
    std::vector<std::pair<std::string, std::string>> keys_;
};

} // namespace

std::string study_model_of(std::string_view text) {
    try {
        const toml::table root = parse_toml(text, "study");
        const auto* model = root.get_as<std::string>("model");
        return model != nullptr ? model->get() : "";
    } catch (const InputError&) {
        return "";
    }
}

ProposedRun proposed_run(const PointOrigin& origin, const Study& study, const ResultFile* file,
                         const ProposalWish& wish) {
    return RunProposal(origin, study, file, wish).propose();
}

} // namespace graze
