#include "auto_peer.hpp"

#include <sys/resource.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace peers {

namespace {

double seconds_of_children() {
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    const auto in_seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return in_seconds(usage.ru_utime) + in_seconds(usage.ru_stime);
}

void write_constants(const AutoSettings& settings, const std::string& file) {
    std::ofstream out(file);
    out << "NDIM= " << settings.states << ", NTST= " << settings.intervals
        << ", NCOL= 4, IAD= 3, NMX= " << settings.points << '\n'
        << "EPSL= " << settings.accuracy << ", EPSU= " << settings.accuracy << ", EPSS= " << 100 * settings.accuracy
        << '\n'
        << "DS= " << settings.first_step << ", DSMIN= 1e-6, DSMAX= " << settings.largest_step << ", IADS= 1\n"
        << "ILP= 1, ISW= 1, IPLT= 0, MXBF= 0, NPR= 100000, IID= 2, ITMX= 9, ITNW= 7, NWTN= 3, JAC= 1\n"
        << settings.constants << '\n';
}

} // namespace

std::vector<double> AutoRun::located(int type) const {
    std::vector<double> result;
    for (const AutoPoint& point : points)
        if (point.type == type)
            result.push_back(point.columns.front());
    return result;
}

AutoRun run_auto(const AutoSettings& settings) {
    const std::string constants = "c." + settings.problem;
    write_constants(settings, constants);
    const double before = seconds_of_children();
    const std::string command = "OMP_NUM_THREADS=1 " GRAZE_AUTO_PROGRAMS "/auto_" + settings.problem + " < " +
                                constants + " > " + settings.problem + ".log 2>&1";
    if (std::system(command.c_str()) != 0)
        throw std::runtime_error("AUTO has failed: " + settings.problem + ".log says why");
    AutoRun run;
    run.seconds = seconds_of_children() - before;
    std::ifstream in("fort.7");
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        int branch = 0, number = 0;
        AutoPoint point;
        if (!(words >> branch) || branch == 0 || !(words >> number >> point.type >> point.label))
            continue;
        for (double column = 0; words >> column;)
            point.columns.push_back(column);
        run.points.push_back(std::move(point));
    }
    if (run.points.empty())
        throw std::runtime_error("AUTO has found nothing: " + settings.problem + ".log says why");
    return run;
}

void keep_solutions() {
    std::filesystem::copy_file("fort.8", "fort.3", std::filesystem::copy_options::overwrite_existing);
}

} // namespace peers
