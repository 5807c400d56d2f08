#include "program.hpp"

#include <algorithm>
#include <iostream>
#include <string>
#include <unistd.h>
#include <vector>

int main(int count, char** values) {
    std::ios::sync_with_stdio(false);
    const std::vector<std::string> arguments(values + std::min(count, 1), values + count); // none, not even a name
    return graze::run_program(arguments, {std::cout, std::cerr, isatty(STDERR_FILENO) == 1});
}
