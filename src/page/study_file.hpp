#pragma once

#include <string>
#include <string_view>

namespace graze {

/// A text that is another one after a file has been changed or replaced; empty: it is not there.
std::string file_trace(const std::string& path);

/// The same of a result file: also after the journal with its latest changes has been written to.
std::string results_trace(const std::string& path);

/// The text of a study, or of the opened model, in a file that somebody edits, perhaps with other programs too. These
/// are the only files but results that the page's server writes.
class StudyFile {
public:
    /// Without a file: it has none yet.
    StudyFile() = default;
    /// @param text that has been read from the file
    StudyFile(std::string path, std::string text);

    bool exists() const { return !path_.empty(); }
    /// Whether the file is there now, as a file: another program may have removed or replaced it.
    bool is_there() const;
    const std::string& path() const { return path_; }
    /// The text of the file when it was last read or written.
    const std::string& text() const { return text_; }

    /// Reads the file again if it may have changed. @return whether its text is another one
    bool look();
    /// Replaces the text of the file, as a whole or not at all.
    /// @throws RefusedRequest when another program has changed or removed the file since it was last read, unless it is
    /// to be replaced all the same; InputError when it cannot be written
    void save(std::string_view text, bool replace);
    /// Gives a text that has no file one in a folder.
    /// @param name a plain name that ends in ".toml"
    /// @throws RefusedRequest when there is a file of that name, InputError for another name
    void save_as(std::string_view text, const std::string& folder, const std::string& name);

private:
    std::string path_; ///< where links lead
    std::string text_;
    std::string seen_; ///< size and time of the file when its text was read
};

} // namespace graze
