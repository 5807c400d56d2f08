#include "sweep/sample_recorder.hpp"
#include "flow/cyclic.hpp"
#include "graze/base/require.hpp"

#include <algorithm>

namespace graze {

namespace {

constexpr auto none = static_cast<std::size_t>(-1);

} // namespace

SampleRecorder::Layout::Layout(const System& system, const std::vector<Sampling>& samplings,
                               const std::vector<Expression>& values)
    : samplings_of_event_(system.model().events.size()), states_(system.states()) {
    const Model& model = system.model();
    parameters_ = system.parameters();
    periods_ = system.periods();
    values_ = system.function_of(values);
    for (std::size_t s = 0; s < samplings.size(); ++s) {
        const Sampling& sampling = samplings[s];
        for (const std::size_t event : sampling.events)
            require_index(event, model.events.size(), "event");
        image_of_sampling_.push_back(sampling.symmetry ? images_.size() : none);
        if (sampling.symmetry)
            images_.push_back(system.symmetry(*sampling.symmetry).map);
        if (sampling.at == Sampling::At::contact) {
            for (const std::size_t event : sampling.events)
                samplings_of_event_.at(event).push_back(s);
            continue;
        }
        Probe probe;
        if (sampling.at == Sampling::At::section) {
            probe = section_probe(model, sampling.section);
        } else {
            probe.name = sampling.name;
            probe.kind = Probe::Kind::extremum;
            probe.expression = sampling.expression;
            probe.direction = sampling.direction;
        }
        probes_.push_back(std::move(probe));
        sampling_of_probe_.push_back(s);
    }
}

std::vector<Probe> SampleRecorder::Layout::probes(const Model& model, const std::string& section) const {
    std::vector<Probe> probes = probes_;
    if (!section.empty())
        probes.push_back(section_probe(model, section));
    return probes;
}

SampleRecorder::SampleRecorder(const Layout& layout, std::size_t first_probe)
    : layout_(&layout), first_probe_(first_probe), inputs_(layout.states_ + layout.parameters_), image_(layout.states_),
      periods_(layout.states_) {
    std::size_t work = std::max(layout.values_.workspace(), layout.periods_.workspace());
    for (const Function& image : layout.images_)
        work = std::max(work, image.workspace());
    work_.resize(work);
    samples_.width = layout.values_.outputs();
}

void SampleRecorder::begin(std::span<const double> parameters) {
    std::ranges::copy(parameters, inputs_.begin() + static_cast<std::ptrdiff_t>(layout_->states_));
    layout_->periods_.evaluate(parameters, periods_, work_);
    samples_.width = layout_->values_.outputs();
    samples_.clear();
    marks_.clear();
    origin_ = 0;
}

void SampleRecorder::passage(const Passage& passage) {
    const std::size_t probe = passage.probe - first_probe_;
    if (passage.probe >= first_probe_ && probe < layout_->sampling_of_probe_.size())
        record(layout_->sampling_of_probe_[probe], passage.time, passage.state);
}

void SampleRecorder::contact(const Contact& contact) {
    if (contact.kind == ContactKind::touch)
        return;
    for (const std::size_t sampling : layout_->samplings_of_event_[contact.event])
        record(sampling, contact.time, contact.before);
}

void SampleRecorder::rest(double time, std::span<const double> state) {
    samples_.clear();
    marks_.clear();
    for (const std::size_t sampling : layout_->sampling_of_probe_)
        record(sampling, time, state);
}

void SampleRecorder::record(std::size_t sampling, double time, std::span<const double> state) {
    std::ranges::copy(state, inputs_.begin());
    if (const std::size_t image = layout_->image_of_sampling_[sampling]; image != none) {
        layout_->images_[image].evaluate(inputs_, image_, work_);
        for (std::size_t i = 0; i < image_.size(); ++i)
            inputs_[i] = within_period(image_[i], periods_[i]);
    }
    samples_.samplings.push_back(sampling);
    samples_.times.push_back(time - origin_);
    samples_.values.resize(samples_.values.size() + samples_.width);
    layout_->values_.evaluate(inputs_, std::span(samples_.values).last(samples_.width), work_);
}

void SampleRecorder::mark() {
    marks_.push_back(samples_.size());
}

void SampleRecorder::keep_last(std::size_t returns) {
    if (marks_.size() <= returns)
        return;
    const std::size_t first = marks_[marks_.size() - 1 - returns];
    marks_.erase(marks_.begin(), marks_.end() - static_cast<std::ptrdiff_t>(returns));
    for (std::size_t& mark : marks_)
        mark -= first;
    const auto drop = [&](auto& list, std::size_t count) {
        list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(count));
    };
    drop(samples_.samplings, first);
    drop(samples_.times, first);
    drop(samples_.values, first * samples_.width);
}

} // namespace graze
