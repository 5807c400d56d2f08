#pragma once

#include "graze/base/input_error.hpp"
#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"
#include "page/page_subject.hpp"
#include "page/study_file.hpp"

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace graze {

/// The text of a study as it is now.
struct StudyText {
    std::string text;
    std::string file;         ///< name of its file, or one that it could have
    std::size_t revision = 1; ///< increases when the text, or a file that the study is read from besides it, changes
    bool saved = true;        ///< whether the file has this text
    bool has_file = true;     ///< false: it was never saved, and needs a name
    std::vector<InputError> errors{};
};

/// The text of the model that was opened.
struct ModelText {
    std::string text;
    std::string file{};       ///< name of its file; empty: it comes with graze, and cannot be saved
    std::size_t revision = 1; ///< increases when the text of the file changes
};

/// How a text is kept.
struct StudySaving {
    bool save = false;    ///< into its file; otherwise in memory only
    std::string file{};   ///< name of a new file in the served folder
    bool replace = false; ///< whether changes by other programs are overwritten
};

/// The study with which results were made, and its models by their names and paths: their files may be elsewhere by
/// now.
struct StoredBeginning {
    Study study;
    NamedModels models;
};

/// What a page works on: a study, whose text changes, and the file of its results. Any thread may use it.
///
/// A study that was opened has its file, and the results that `graze run` would make. Of a model the study is the one
/// that was saved for it, MODEL-study.toml, or goes on from its results, or is a new one, without runs. Results contain
/// the study with which they were made, but not its text: the text has further runs, which go on from those.
class StudySession {
public:
    /// @param folder of the results of a study or model, and of a text that has no file; empty: texts are saved in the
    ///        current folder, and results in a folder there that has the study's name, as `graze run` does
    ///        A text that goes on from results is saved beside them.
    /// @throws InputError when the subject cannot be read
    explicit StudySession(PageSubject subject, const std::string& folder = "");

    const PageSubject& subject() const { return subject_; }
    std::string title() const;
    const std::string& results_path() const { return results_path_; }
    /// A handle for reading; none if nothing has been computed yet. @throws InputError when the file cannot be read
    std::optional<ResultFile> results() const;
    bool can_compute() const;

    StudyText text() const;
    /// The study when its text was last without mistakes.
    std::shared_ptr<const Study> study() const;
    /// The same where the text has no mistakes. @throws InputErrors, InputError
    std::shared_ptr<const Study> faultless_study() const;
    /// The runs of the results that are not what the study asks for now (outdated_runs).
    std::set<std::string> outdated(const ResultFile& file) const;
    /// The path of the study's file, or of one that it could have: mistakes in it have this place.
    std::string studied_file() const;
    /// Checks a text as the study's. @throws InputErrors, InputError with the places of mistakes
    Study read(const std::string& text) const;

    /// Replaces the text, which may have mistakes. @param revision of the text that it was made from
    /// @throws RefusedRequest when somebody else has changed the text or its file, InputError when it cannot be written
    StudyText keep(const std::string& text, std::size_t revision, const StudySaving& saving);
    /// The text of the opened model, as its file has it by now; none: no model was opened.
    std::optional<ModelText> model_text();
    /// Saves a text in the file of the opened model, and reads the study again. @param revision, replace as for `keep`
    /// @throws InputErrors, InputError for mistakes: nothing changes then; RefusedRequest as for `keep`
    ModelText keep_model(const std::string& text, std::size_t revision, bool replace);
    /// Adds runs to the text, and pictures. @return the names of the runs
    /// @throws InputError for mistakes, with lines of the addition, when it has no new run, and when it has anything
    /// else, which could change the runs that there are: nothing changes then
    std::vector<std::string> append(const std::string& addition);
    /// Reads the study again if another program has changed its file, a model's or another one that it is read from. A
    /// text that is not saved stays as it is.
    /// @return whether it was read again
    bool look();
    /// Takes over what another program has added to the results since they were opened, so that runs may go on from it.
    void look_at_results();

private:
    std::string path_of_results(const std::string& study) const;
    void begin_study();
    void begin_results();
    void begin_model();
    /// Of a model that was opened before.
    void begin_saved_study(const std::string& text);
    /// @param model for all further runs; empty: none
    void go_on_from(Study stored, const std::string& model);
    std::string text_after(const Study& stored, const std::string& model) const;
    /// Files besides the study's own, by their paths, as they were when they were read (file_trace).
    using InputTraces = std::map<std::string, std::string>;
    void change(std::string text, std::shared_ptr<const Study> study, std::vector<InputError> errors,
                const InputTraces& before);
    void change_and_read(const std::string& text);
    void note_inputs(const InputTraces& before);
    InputTraces present_inputs() const;
    std::shared_ptr<const StoredBeginning> base() const;

    PageSubject subject_;
    std::string folder_;
    bool named_folder_;
    std::string results_path_;
    std::string file_name_; ///< for messages, and for its first saving

    std::mutex editing_;                          ///< one change after the other; always taken before the next one
    mutable std::mutex mutex_;                    ///< of all below
    std::shared_ptr<const StoredBeginning> base_; ///< from which the text goes on; null: from nothing
    StudyFile file_;
    StudyFile model_file_; ///< of the opened model
    std::size_t model_revision_ = 1;
    std::string text_;
    std::string first_text_; ///< that was made for opened results; empty: for none
    std::size_t revision_ = 1;
    std::shared_ptr<const Study> study_;
    std::vector<InputError> errors_;
    InputTraces inputs_;

    /// What was found outdated last: of this study, and of results in this state.
    struct Comparison {
        std::shared_ptr<const Study> study;
        std::string results;
        std::set<std::string> outdated;
    };
    mutable std::mutex comparing_; ///< of the next one only
    mutable Comparison compared_;
};

} // namespace graze
