#include "base/special_numbers.hpp"
#include "graze/atlas/atlas_tables.hpp"
#include "graze/base/input_error.hpp"
#include "graze/study/stored_study.hpp"
#include "graze/symbolic/transform.hpp"
#include "picture/atlas_drawing.hpp"
#include "picture/attractor_classes.hpp"
#include "picture/box.hpp"
#include "picture/branch_lines.hpp"
#include "picture/picture_kinds.hpp"
#include "picture/section_passages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace graze {

namespace {

AtlasMotion stable_motion_of(const AtlasBranch& branch) {
    AtlasMotion motion;
    motion.label = Label::periodic;
    motion.period = branch.multiple;
    motion.contacts = branch.contacts;
    return motion;
}

std::vector<AtlasMotion> stable_motions_of(const std::vector<AtlasBranch>& branches) {
    std::vector<AtlasMotion> motions;
    for (const AtlasBranch& branch : branches)
        motions.push_back(stable_motion_of(branch));
    return motions;
}

/// A value of motions where they pass a section, so that samples and orbits can be drawn together.
struct SectionValue {
    NamedValue value;
    std::string section, sampling;
};

constexpr std::size_t most_points = 40; ///< that are marked in a diagram

class AtlasDiagram {
public:
    AtlasDiagram(const StudyPicture& picture, const DrawnAtlas& atlas)
        : picture_(&picture), atlas_(&atlas), findings_(&atlas.findings),
          classes_(atlas.motions, stable_motions_of(findings_->branches)), x_(findings_->axes[0].name) {
        for (const AtlasPoint& point : findings_->points)
            for (const std::string& found : point.found)
                names_[found] = point.name;
    }

    ResultPicture drawn() {
        const std::optional<SectionValue> section = section_value();
        y_ = !picture_->y.empty() ? picture_->y.front() : section ? section->value.name : first_monitor();
        panel_ = panel_of(*picture_, axes_run(section.has_value()), x_, y_, 0);
        panel_.roomy_y = true;
        if (!panel_.x_range)
            panel_.x_range = shown_range(findings_->axes[0]);
        for (const AtlasBranch& branch : findings_->branches)
            read(branch, section);
        leave_points_out();
        add_class_legend();
        if (section)
            add_samples(*section);
        for (const DrawnBranch& branch : branches_)
            for (std::size_t v = 0; v < passages_of(branch); ++v)
                add_lines(panel_, branch, v);
        for (const DrawnBranch& branch : branches_)
            for (std::size_t v = 0; v < passages_of(branch); ++v)
                add_symbols(panel_, *picture_, branch, v, v == 0);
        add_looks(panel_, branches_, FigureSeries::black);
        add_point_types(panel_, *picture_, branches_, FigureSeries::black);
        ResultPicture made;
        made.figure.panels.push_back(std::move(panel_));
        made.table = curves_and_points(*findings_);
        return made;
    }

private:
    /// The first sampled value that is not constant, unless the picture chooses another; none: no section is sampled,
    /// or the picture shows something else.
    std::optional<SectionValue> section_value() const {
        const StudyRun asked = stored_run(atlas_->run.record);
        const auto& samplings = asked.motion().samplings;
        const auto sampling = std::ranges::find(samplings, Sampling::At::section, &Sampling::at);
        if (sampling == samplings.end() || sampling->symmetry)
            return std::nullopt;
        std::optional<SectionValue> first;
        for (std::size_t i = 0; i < asked.values.size(); ++i) {
            const std::string& name = asked.value_names[i];
            if (!picture_->y.empty() && picture_->y.front() != name)
                continue;
            NamedValue value = named_value(asked.model, to_string(asked.values[i]), picture_->place);
            value.name = name;
            const SectionValue one{std::move(value), sampling->section, sampling->name};
            if (!is_constant(one))
                return one;
            if (!first)
                first = one;
        }
        return first;
    }

    bool is_constant(const SectionValue& one) const {
        Extent extent;
        auto rows = atlas_->run.rows({.samples = true, .values = {one.value.name}, .samplings = {one.sampling}});
        while (rows.next())
            if (!rows.is_null(0))
                extent.add(rows.number(0));
        return extent.is_constant();
    }

    /// A monitor of all branches.
    std::string first_monitor() const {
        if (findings_->branches.empty())
            return "period";
        const StoredRun run(atlas_->run.file, findings_->branches.front().run, picture_->place);
        for (const std::string& name : run.value_names())
            if (name != "period")
                return name;
        return "period";
    }

    /// The run that has descriptions of the values.
    StoredRun axes_run(bool of_samples) const {
        return of_samples || findings_->branches.empty()
                   ? atlas_->run
                   : StoredRun(atlas_->run.file, findings_->branches.front().run, picture_->place);
    }

    void read(const AtlasBranch& branch, const std::optional<SectionValue>& section) {
        StudyPicture all = *picture_;
        all.directions.clear(); // which are those of motions
        const StoredRun run(atlas_->run.file, branch.run, picture_->place);
        DrawnBranch& drawn = branches_.emplace_back();
        drawn.run = branch.run;
        drawn.colour = classes_.all()[classes_.index_of(stable_motion_of(branch))].colour;
        drawn.points = drawn_points(run, all, x_, section ? std::vector<std::string>{} : std::vector{y_});
        if (section)
            read_passages(drawn, run, *section);
        for (DrawnPoint& point : drawn.points) {
            const auto name = names_.find(branch.run + ":" + point.label);
            point.name = name == names_.end() ? "" : name->second;
        }
    }

    /// What each orbit has where it passes the section, in such an order that each passage of a branch makes a line.
    static void read_passages(DrawnBranch& branch, const StoredRun& run, const SectionValue& section) {
        SectionPassages passages(run.model, section.section, section.value);
        std::map<std::size_t, std::vector<double>> values; // by number
        for (const OrbitRecord& record : run.file.orbits(run.record.name, false))
            values[record.number] = passages.of(record.point.solution.orbit);
        std::size_t most = 0;
        const DrawnPoint* before = nullptr;
        for (DrawnPoint& point : branch.points) {
            point.y = std::move(values[point.number]);
            // Both ways begin at the first orbit.
            if (before)
                align_passages(point.y, before->part == point.part ? before->y : branch.points.front().y);
            before = &point;
            most = std::max(most, point.y.size());
        }
        for (DrawnPoint& point : branch.points)
            point.y.resize(most, not_a_number);
    }

    static std::size_t passages_of(const DrawnBranch& branch) {
        return branch.points.empty() ? 0 : branch.points.front().y.size();
    }

    /// Of too many points to be told apart, only those are marked at which a stable stretch begins or ends, or that lie
    /// in one.
    void leave_points_out() {
        if (marked() <= most_points || !picture_->points.empty())
            return;
        const std::size_t all = marked();
        for (DrawnBranch& branch : branches_)
            for (std::size_t i = 0; i < branch.points.size(); ++i)
                branch.points[i].left_out = !is_stable(branch, i, i - 1) && !is_stable(branch, i, i + 1);
        if (const std::size_t left = all - marked(); left > 0)
            panel_.notes.push_back(fmt::format("not marked: {} points at which no stable orbits begin or end", left));
    }

    std::size_t marked() const {
        std::size_t count = 0;
        for (const DrawnBranch& branch : branches_)
            count += static_cast<std::size_t>(std::ranges::count_if(
                branch.points, [&](const DrawnPoint& point) { return is_marked(*picture_, point); }));
        return count;
    }

    /// Whether the orbit beside a point is stable.
    static bool is_stable(const DrawnBranch& branch, std::size_t point, std::size_t beside) {
        return beside < branch.points.size() && branch.points[beside].part == branch.points[point].part &&
               branch.points[beside].look == Look::stable;
    }

    /// Each class of branches; the others are explained by their samples.
    void add_class_legend() {
        for (const AtlasBranch& branch : findings_->branches)
            of_branches_.insert(classes_.index_of(stable_motion_of(branch)));
        for (const std::size_t c : of_branches_)
            add_to_legend(panel_, shown_name(*picture_, classes_.all()[c].name), FigureSeries::Style::line,
                          classes_.all()[c].colour);
    }

    void add_samples(const SectionValue& section) {
        std::map<std::size_t, std::size_t> classes; // by the number of the motion
        for (const AtlasMotion& motion : atlas_->motions)
            if (drawn_as(name_of(motion.label)) != DrawnAs::nothing)
                classes[motion.number] = classes_.index_of(motion);
        const std::size_t before = panel_.series.size();
        for (std::size_t c = 0; c < classes_.all().size(); ++c) {
            const AttractorClass& one = classes_.all()[c];
            FigureSeries& series = panel_.series.emplace_back();
            if (!of_branches_.contains(c))
                series.title = shown_name(*picture_, one.name);
            series.style = one.drawn == DrawnAs::uncertain ? FigureSeries::Style::symbols : FigureSeries::Style::dots;
            series.colour = one.colour;
            series.symbol = one.symbol;
            series.run = findings_->run;
        }
        auto rows = atlas_->run.rows({.samples = true,
                                      .columns = {"number"},
                                      .quantities = {x_},
                                      .values = {section.value.name},
                                      .directions = picture_->directions,
                                      .samplings = {section.sampling}});
        while (rows.next()) {
            const auto number = static_cast<std::size_t>(rows.integer(0));
            if (const auto found = classes.find(number); found != classes.end() && !rows.is_null(2))
                panel_.series[before + found->second].add({rows.number(1), rows.number(2)}, number);
        }
        std::erase_if(panel_.series,
                      [](const FigureSeries& series) { return series.points.empty() && !series.only_in_legend; });
        if (const std::string note = note_of_left_out(atlas_->run, picture_->directions); !note.empty())
            panel_.notes.push_back(note);
    }

    const StudyPicture* picture_;
    const DrawnAtlas* atlas_;
    const AtlasFindings* findings_;
    AttractorClasses classes_;
    std::string x_, y_;
    std::map<std::string, std::string> names_; ///< of points, by "RUN:LABEL"
    FigurePanel panel_;
    std::vector<DrawnBranch> branches_; ///< in the order of the findings; each value is a passage of the section
    std::set<std::size_t> of_branches_; ///< classes that branches belong to
};

} // namespace

ResultPicture atlas_diagram(const StudyPicture& picture, const DrawnAtlas& atlas) {
    if (picture.y.size() > 1)
        throw InputError(picture.place, "the picture of an atlas has one y axis", "name one value");
    return AtlasDiagram(picture, atlas).drawn();
}

} // namespace graze
