#include "program.hpp"

#include <iostream>
#include <string>
#include <unistd.h>
#include <vector>

int main(int count, char** values) {
    std::ios::sync_with_stdio(false);
    const std::vector<std::string> arguments(values + 1, values + count);
    return graze::run_program(arguments, {std::cout, std::cerr, isatty(STDERR_FILENO) == 1});
}
