#include "cli/program.hpp"

int main(int argc, char** argv) {
    return actformer::cli::run_program(argc, argv, actformer::cli::add_render);
}
