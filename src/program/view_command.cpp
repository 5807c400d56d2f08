#include "graze/base/input_error.hpp"
#include "graze/page/page_server.hpp"
#include "graze/results/query_interruption.hpp"
#include "program/commands.hpp"
#include "program/interrupt.hpp"
#include "program/process.hpp"
#include "program/temporary_files.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#ifdef __GLIBC__ // which the headers above define
#include <malloc.h>
#endif

#include <cstdlib>
#include <filesystem>
#include <memory>

namespace graze {

namespace {

/// A file of the user alone that leads a browser to an address. On a command line, others could read the token in it.
class LeadingFile {
public:
    explicit LeadingFile(const std::string& address)
        : path_((std::filesystem::temp_directory_path() / "graze-XXXXXX.html").string()) {
        constexpr int ending = 5; // ".html"
        const int file = ::mkstemps(path_.data(), ending);
        if (file < 0)
            throw InputError(Place{path_, 0, 0}, "the file cannot be made",
                             "open the address yourself, without --open");
        TemporaryFiles::add(path_);
        const std::string text = fmt::format(
            "<!doctype html><meta charset=\"utf-8\"><meta http-equiv=\"refresh\" content=\"0; url={}\">\n", address);
        [[maybe_unused]] const ssize_t written = ::write(file, text.data(), text.size());
        ::close(file);
    }
    ~LeadingFile() {
        ::unlink(path_.c_str());
        TemporaryFiles::take_out(path_);
    }
    LeadingFile(const LeadingFile&) = delete;
    LeadingFile& operator=(const LeadingFile&) = delete;

    const std::string& path() const { return path_; }

private:
    std::string path_;
};

/// Starts a program that outlives this one, and that Ctrl-C does not end with it.
void start_apart(const std::string& program, const std::string& argument) {
    const pid_t child = ::fork();
    if (child == 0) { // only functions that are safe after a fork of one of several threads
        ::setsid();
        if (::fork() != 0)
            ::_exit(0);
        const int nothing = ::open("/dev/null", O_RDWR);
        for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
            ::dup2(nothing, stream);
        ::execl(program.c_str(), program.c_str(), argument.c_str(), nullptr);
        ::_exit(1);
    }
    if (child > 0)
        ::waitpid(child, nullptr, 0);
}

/// Opens an address in the browser of the desktop.
std::unique_ptr<LeadingFile> open_in_browser(const std::string& address) {
    const auto opener = find_program("xdg-open");
    if (!opener)
        throw InputError(Place{"--open", 0, 0}, "the program xdg-open, which opens a browser, is not there",
                         "install xdg-utils, or open the address yourself");
    auto file = std::make_unique<LeadingFile>(address);
    start_apart(*opener, file->path());
    return file;
}

/// Gives large memory back to the system as soon as it is free. By default the C library keeps more and more of it:
/// each text of a study that is edited, with all values of its runs, would leave something.
void give_memory_back() {
#ifdef __GLIBC__
    constexpr int large = 256 << 10;
    mallopt(M_MMAP_THRESHOLD, large);
#endif
}

/// A file may take long to open, which can be interrupted as all else. @return null: it was
std::unique_ptr<PageServer> opened_server(const PageOptions& options) {
    const QueryInterruption stoppable([] { return InterruptGuard::requested(); });
    try {
        return std::make_unique<PageServer>(options);
    } catch (const InputError&) {
        if (InterruptGuard::requested())
            return nullptr;
        throw;
    }
}

} // namespace

int view_command(const ViewArguments& arguments, const Console& console) {
    PageOptions options;
    options.opened = arguments.opened;
    options.model = arguments.model;
    options.port = arguments.port;
    options.folder = arguments.folder;
    options.threads = threads_for(arguments.jobs);
    give_memory_back();
    const InterruptGuard guard;
    const std::unique_ptr<PageServer> opened = opened_server(options);
    if (!opened)
        return InterruptGuard::exit_code();
    PageServer& server = *opened;
    server.start();
    if (!has_page())
        console.err
            << "graze: this build has no page, only the interface of docs/page-interface.md; build it where npm "
               "and esbuild are to have the page\n";
    console.out << server.address() << std::endl; // at once, for a program that waits for it
    if (console.terminal)
        console.err << "graze: open this address in a browser; Ctrl-C ends it\n";
    const std::unique_ptr<LeadingFile> leading = arguments.open ? open_in_browser(server.address()) : nullptr;
    PageServer::wait([] { return InterruptGuard::requested(); });
    server.stop();
    return exit_success;
}

} // namespace graze
