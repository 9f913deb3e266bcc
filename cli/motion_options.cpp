#include "cli/motion_options.hpp"

#include "base/error.hpp"
#include "base/files/nearest_file.hpp"
#include "cli/common_options.hpp"
#include "eval/scoring/motions_file_source.hpp"
#include "eval/scoring/windows_source.hpp"
#include "ingest/dataset/dataset.hpp"

namespace actformer::cli {

std::unique_ptr<eval::MotionSource> MotionOptions::open(kernels::Device& on,
                                                        const eval::FeatureExtractor& extractor) const {
    if (!std::filesystem::exists(input))
        throw Error("{}: no such file or folder{}", input.string(), did_you_mean(input));
    if (!std::filesystem::is_directory(input)) {
        refuse_given(*command, {"--split", "--window"},
                     "is for datasets, and " + input.string() + " is a file");
        return eval::open_motions(input, {frames, batch, {}});
    }
    refuse_given(*command, {"--frames"},
                 "is for motions files; --window sets the frames of a dataset's windows");
    const auto dataset = ingest::one_dataset_at(input);
    const auto joints = extractor.joints_of(eval::describe(ingest::Dataset(dataset)));
    return eval::open_windows(on, {dataset, split, window, batch, joints});
}

void add_motion_options(CLI::App* command, MotionOptions& options) {
    options.command = command;
    command->add_option("--recogniser", options.recogniser, "Folder of its training, or its weights")
        ->required()
        ->type_name("RUN|WEIGHTS.h5");
    command->add_option("input", options.input, "Motions file in the public layout, or dataset folder")
        ->required()
        ->type_name("INPUT");
    command->add_option("--frames", options.frames, "Take the first N frames of every motion (default: all)")
        ->check(CLI::Range(1, 1'000'000));
    command->add_option("--split", options.split, "Split of the dataset")->capture_default_str();
    command->add_option("--window", options.window, "Frames of the windows that a dataset is cut into")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    command->add_option("--batch", options.batch, "Sequences handed to the device together")
        ->check(CLI::Range(1, 65536))
        ->capture_default_str();
    add_device_option(command, options.device);
}

}  // namespace actformer::cli
