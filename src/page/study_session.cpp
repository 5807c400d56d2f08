#include "page/study_session.hpp"

#include "graze/base/file_name.hpp"
#include "graze/base/input_errors.hpp"
#include "graze/base/text_file.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"
#include "graze/study/further_runs.hpp"
#include "graze/study/outdated_runs.hpp"
#include "graze/study/stored_study.hpp"
#include "page/error_answer.hpp"
#include "page/study_addition.hpp"
#include "page/toml_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <unistd.h>

namespace graze {

namespace {

std::set<std::string> run_names(const Study& study) {
    std::set<std::string> names;
    for (const StudyRun& run : study.runs)
        names.insert(run.name);
    return names;
}

/// The study with what the earlier one has besides runs.
Study with_rest_of(Study study, const Study& earlier) {
    const auto add = [](auto& items, const auto& before) {
        auto all = before;
        for (auto& item : items) {
            std::erase_if(all, [&](const auto& one) { return one.name == item.name; });
            all.push_back(std::move(item));
        }
        items = std::move(all);
    };
    add(study.pictures, earlier.pictures);
    add(study.tables, earlier.tables);
    study.set = earlier.set; // with which its results were made
    if (study.text.empty())
        study.text = earlier.text;
    if (study.source.empty())
        study.source = earlier.source;
    return study;
}

std::shared_ptr<const StoredBeginning> beginning_of(Study study) {
    StoredBeginning beginning{std::move(study), {}};
    for (const StudyRun& run : beginning.study.runs) {
        if (!run.model.name.empty() && !find_in_catalogue(run.model.name))
            beginning.models.emplace(run.model.name, run.model);
        if (!run.model_path.empty())
            beginning.models.emplace(run.model_path, run.model);
    }
    return std::make_shared<StoredBeginning>(std::move(beginning));
}

/// The model of all runs; empty: they have several.
std::string only_model_of(const Study& study) {
    std::set<std::string> named;
    for (const StudyRun& run : study.runs)
        named.insert(run.model.name);
    return named.size() == 1 ? *named.begin() : "";
}

std::vector<InputError> errors_in(const std::function<void()>& work) {
    try {
        work();
    } catch (const InputErrors& errors) {
        return errors.all();
    } catch (const InputError& error) {
        return {error};
    }
    return {};
}

[[noreturn]] void throw_all(const std::vector<InputError>& errors) {
    if (errors.size() == 1)
        throw InputError(errors.front());
    throw InputErrors(errors);
}

} // namespace

StudySession::StudySession(PageSubject subject, const std::string& folder)
    : subject_(std::move(subject)), folder_(folder.empty() ? "." : folder), named_folder_(!folder.empty()) {
    switch (subject_.kind) {
    case PageSubject::Kind::results:
        begin_results();
        break;
    case PageSubject::Kind::study:
        begin_study();
        break;
    case PageSubject::Kind::model:
        begin_model();
        break;
    }
    note_inputs({});
}

std::string StudySession::path_of_results(const std::string& study) const {
    const std::filesystem::path folder(folder_);
    return ((named_folder_ ? folder : folder / study) / "results.sqlite").lexically_normal().string();
}

void StudySession::begin_study() {
    if (!subject_.path.empty())
        file_ = StudyFile(subject_.path, subject_.text);
    text_ = subject_.text;
    file_name_ = subject_.path.empty() ? free_study_file(folder_, subject_.name) : subject_.path;
    study_ = std::make_shared<Study>(parse_study(text_, file_name_));
    results_path_ = path_of_results(study_->name);
}

void StudySession::begin_results() {
    results_path_ = subject_.path;
    if (!named_folder_)
        folder_ = std::filesystem::absolute(results_path_).parent_path().string();
    Study stored = stored_study(ResultFile(results_path_, ResultFile::Access::read));
    const std::string model = only_model_of(stored);
    go_on_from(std::move(stored), model);
    first_text_ = text_;
}

std::string StudySession::text_after(const Study& stored, const std::string& model) const {
    std::string text = fmt::format("# Runs that go on from those of {}\nname = {}\n",
                                   std::filesystem::path(results_path_).filename().string(), toml_value(stored.name));
    if (!model.empty())
        text += fmt::format("model = {}\n", toml_value(model));
    return text;
}

void StudySession::go_on_from(Study stored, const std::string& model) {
    base_ = beginning_of(std::move(stored));
    const Study& study = base_->study;
    file_name_ = free_study_file(folder_, study.name + "-further");
    text_ = text_after(study, model);
    study_ = std::make_shared<Study>(study);
}

void StudySession::begin_model() {
    if (!subject_.path.empty())
        model_file_ = StudyFile(subject_.path, subject_.text);
    const Model model = parse_model(subject_.text, subject_.name);
    const std::string stem = std::filesystem::path(subject_.name).stem().string();
    Study study;
    study.name = subject_.path.empty() ? subject_.name : is_file_name(stem) ? stem : "study";
    std::string named = subject_.name;
    if (!subject_.path.empty()) {
        std::error_code error;
        // Relative to the folder where the study's file will be, if it is there already; a slash makes it a path.
        const std::filesystem::path path = std::filesystem::canonical(subject_.path);
        named = (std::filesystem::exists(folder_, error) ? std::filesystem::proximate(path, folder_) : path).string();
        if (!is_model_path(named))
            named = "./" + named;
    }
    text_ = fmt::format("name = {}\nmodel = {}\n", toml_value(study.name), toml_value(named));
    results_path_ = path_of_results(study.name);
    const std::string name = study.name + "-study";
    file_name_ = (std::filesystem::path(folder_) / (name + ".toml")).lexically_normal().string();
    const bool there = std::filesystem::is_regular_file(file_name_);
    const std::string saved = there ? read_text_file(file_name_, "study", longest_model) : "";
    const bool goes_on = there && is_study_of(saved, named, folder_);
    if (there && !goes_on)
        file_name_ = free_study_file(folder_, name);
    study.file = file_name_;
    study.text = model.text;
    study_ = std::make_shared<Study>(std::move(study));
    if (goes_on)
        begin_saved_study(saved);
    else if (const auto file = results(); file && !file->runs().empty())
        go_on_from(stored_study(*file), named);
}

void StudySession::begin_saved_study(const std::string& text) {
    file_ = StudyFile(file_name_, text);
    text_ = text;
    change_and_read(text); // mistakes are shown with the text
    results_path_ = path_of_results(study_->name);
}

std::string StudySession::title() const {
    const std::shared_ptr<const Study> now = study();
    return now->text.empty() ? now->name : now->text;
}

std::optional<ResultFile> StudySession::results() const {
    return ResultFile::find(results_path_);
}

bool StudySession::can_compute() const {
    std::error_code error;
    std::filesystem::path folder = std::filesystem::absolute(results_path_, error).parent_path();
    while (!folder.empty() && folder != folder.root_path() && !std::filesystem::exists(folder, error))
        folder = folder.parent_path();
    return ::access(folder.c_str(), W_OK) == 0 &&
           (!std::filesystem::exists(results_path_, error) || ::access(results_path_.c_str(), W_OK) == 0);
}

std::shared_ptr<const StoredBeginning> StudySession::base() const {
    const std::lock_guard lock(mutex_);
    return base_;
}

std::string StudySession::studied_file() const {
    const std::lock_guard lock(mutex_);
    return file_.exists() ? file_.path() : file_name_;
}

Study StudySession::read(const std::string& text) const {
    const std::string file = studied_file();
    const std::shared_ptr<const StoredBeginning> base = this->base();
    if (may_have_runs(text, file))
        return base ? with_rest_of(parse_further_runs(text, file, base->study, base->models), base->study)
                    : parse_study(text, file);
    if (base)
        return base->study;
    if (subject_.kind != PageSubject::Kind::model)
        return parse_study(text, file); // which says what is missing
    Study without_runs = *study();
    without_runs.runs.clear();
    without_runs.pictures.clear();
    without_runs.tables.clear();
    return without_runs;
}

StudyText StudySession::text() const {
    const std::lock_guard lock(mutex_);
    const std::string file = file_.exists() ? file_.path() : file_name_;
    return {text_,          std::filesystem::path(file).filename().string(),
            revision_,      file_.is_there() && file_.text() == text_,
            file_.exists(), errors_};
}

std::shared_ptr<const Study> StudySession::study() const {
    const std::lock_guard lock(mutex_);
    return study_;
}

std::shared_ptr<const Study> StudySession::faultless_study() const {
    const std::lock_guard lock(mutex_);
    if (!errors_.empty())
        throw_all(errors_);
    return study_;
}

std::set<std::string> StudySession::outdated(const ResultFile& file) const {
    const std::shared_ptr<const Study> study = this->study();
    const std::shared_ptr<const StoredBeginning> base = this->base();
    if (base && study->runs.size() == base->study.runs.size())
        return {}; // the study is that of the results
    std::string results;
    for (const RunRecord& run : file.runs())
        results += fmt::format("{} {} {}\n", run.name, run.fingerprint, name_of(run.status));
    const std::lock_guard one_by_one(comparing_);
    if (compared_.study != study || compared_.results != results)
        compared_ = {study, results, outdated_runs(*study, file)};
    return compared_.outdated;
}

StudySession::InputTraces StudySession::present_inputs() const {
    InputTraces inputs;
    {
        const std::lock_guard lock(mutex_);
        inputs = inputs_;
    }
    for (auto& [path, trace] : inputs)
        trace = file_trace(path);
    return inputs;
}

/// Notes which files the study is read from, and those in which it has mistakes. @param before they were read
void StudySession::note_inputs(const InputTraces& before) {
    std::set<std::string> files;
    if (subject_.kind == PageSubject::Kind::model && !subject_.path.empty())
        files.insert(subject_.path);
    for (const StudyRun& run : study_->runs)
        if (!base_ || base_->study.find_run(run.name) == nullptr) // stored ones are not read from files
            for (const std::string& path : input_files(run))
                files.insert(path);
    for (const InputError& error : errors_)
        if (!error.place().file.empty())
            files.insert(error.place().file);
    // The study's own is looked at by itself, since its changes are not taken over where the text is not saved.
    files.erase(file_.exists() ? file_.path() : file_name_);
    inputs_.clear();
    for (const std::string& path : files) {
        const auto found = before.find(path);
        inputs_[path] = found == before.end() ? file_trace(path) : found->second;
    }
}

void StudySession::change(std::string text, std::shared_ptr<const Study> study, std::vector<InputError> errors,
                          const InputTraces& before) {
    const std::lock_guard lock(mutex_);
    if (text != text_ || before != inputs_)
        ++revision_;
    text_ = std::move(text);
    errors_ = std::move(errors);
    if (study)
        study_ = std::move(study);
    note_inputs(before);
}

void StudySession::change_and_read(const std::string& text) {
    const InputTraces before = present_inputs();
    std::shared_ptr<const Study> study;
    std::vector<InputError> errors = errors_in([&] { study = std::make_shared<Study>(read(text)); });
    change(text, std::move(study), std::move(errors), before);
}

StudyText StudySession::keep(const std::string& text, std::size_t revision, const StudySaving& saving) {
    const std::lock_guard one_by_one(editing_);
    if (text.find('\0') != std::string::npos)
        throw InputError("the text of the study has a zero byte", "remove it");
    if (const StudyText now = this->text(); revision != now.revision)
        throw RefusedRequest(409, "the study has been changed meanwhile", "look at its text first");
    if (saving.save) {
        const std::lock_guard lock(mutex_);
        if (!saving.file.empty())
            file_.save_as(text, folder_, saving.file);
        else if (file_.exists())
            file_.save(text, saving.replace);
        else
            throw InputError("this study has no file yet", "name one");
    }
    change_and_read(text);
    return this->text();
}

std::optional<ModelText> StudySession::model_text() {
    if (subject_.kind != PageSubject::Kind::model)
        return std::nullopt;
    const std::lock_guard lock(mutex_);
    if (!model_file_.exists())
        return ModelText{subject_.text};
    if (model_file_.look())
        ++model_revision_;
    return ModelText{model_file_.text(), std::filesystem::path(model_file_.path()).filename().string(),
                     model_revision_};
}

ModelText StudySession::keep_model(const std::string& text, std::size_t revision, bool replace) {
    const std::lock_guard one_by_one(editing_);
    const std::optional<ModelText> now = model_text();
    if (!now || now->file.empty())
        throw InputError("no file of a model was opened", "download the text, and open its file");
    if (revision != now->revision && !replace)
        throw RefusedRequest(409, fmt::format("another program has changed {}", now->file),
                             "look at its text first, or save over it deliberately");
    parse_model(text, now->file);
    {
        const std::lock_guard lock(mutex_);
        model_file_.save(text, replace);
        ++model_revision_;
    }
    change_and_read(this->text().text);
    return *model_text();
}

std::vector<std::string> StudySession::append(const std::string& addition) {
    const std::lock_guard one_by_one(editing_);
    const InputTraces inputs = present_inputs();
    require_only_new(addition, *study());
    std::string text = this->text().text;
    if (!text.empty() && !text.ends_with('\n'))
        text += '\n';
    if (!text.empty())
        text += '\n';
    const auto lines = static_cast<int>(std::ranges::count(text, '\n'));
    text += addition;
    if (!text.ends_with('\n'))
        text += '\n';
    std::shared_ptr<const Study> changed;
    std::vector<InputError> errors = errors_in([&] { changed = std::make_shared<Study>(read(text)); });
    for (InputError& error : errors)
        if (error.place().line > lines && error.place().file == studied_file())
            error = InputError(Place{"", error.place().line - lines, error.place().column}, error.problem(),
                               error.remedy());
    if (!errors.empty())
        throw_all(errors);
    const std::set<std::string> before = run_names(*study());
    std::vector<std::string> added;
    for (const StudyRun& run : changed->runs)
        if (!before.contains(run.name))
            added.push_back(run.name);
    if (added.empty())
        throw InputError("the text adds no run to the study", "give a table [runs.NAME]");
    change(std::move(text), std::move(changed), {}, inputs);
    return added;
}

bool StudySession::look() {
    const std::lock_guard one_by_one(editing_);
    const InputTraces inputs = present_inputs();
    std::string text;
    {
        const std::lock_guard lock(mutex_);
        const bool saved = file_.text() == text_;
        StudyFile now = file_;
        // Unless the change is taken over, the next saving has to notice it.
        const bool other_text = saved && now.look();
        if (other_text)
            file_ = now;
        else if (inputs == inputs_)
            return false;
        text = other_text ? file_.text() : text_;
    }
    change_and_read(text);
    return true;
}

void StudySession::look_at_results() {
    const std::lock_guard one_by_one(editing_);
    if (!base())
        return;
    Study stored = stored_study(ResultFile(results_path_, ResultFile::Access::read));
    const std::set<std::string> before = run_names(base()->study), now = run_names(*study());
    // The text has these, and they were computed here.
    std::erase_if(stored.runs,
                  [&](const StudyRun& run) { return now.contains(run.name) && !before.contains(run.name); });
    if (run_names(stored) == before)
        return;
    std::string text = this->text().text;
    // The file may have been replaced by one of another study: what nobody has changed is made anew.
    if (!first_text_.empty() && text == first_text_)
        text = first_text_ = text_after(stored, only_model_of(stored));
    std::shared_ptr<const StoredBeginning> beginning = beginning_of(std::move(stored));
    {
        const std::lock_guard lock(mutex_);
        base_ = std::move(beginning);
    }
    change_and_read(text);
}

} // namespace graze
