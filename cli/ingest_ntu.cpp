// actformer ingest ntu: NTU RGB+D .skeleton files to the datasets ntu-1p and ntu-2p.
#include "cli/ingest.hpp"
#include "ingest/formats/ntu/name.hpp"
#include "ingest/formats/ntu/ntu_format.hpp"

namespace actformer::cli {

void add_ingest_ntu(CLI::App& ingest) {
    struct Options : IngestOptions {
        std::string missing;
    };
    auto options = std::make_shared<Options>();
    auto* command = ingest.add_subcommand("ntu", "NTU RGB+D .skeleton files -> DIR/ntu-1p and DIR/ntu-2p");
    add_ingest_options(command, *options);
    command
        ->add_option("--missing", options->missing, "The list of clips with missing skeletons, to leave out")
        ->type_name("LIST");
    examples(
        command,
        "  actformer ingest ntu nturgbd_skeletons_s001_to_s017.zip nturgbd_skeletons_s018_to_s032.zip \\\n"
        "      --missing NTU_RGBD120_samples_with_missing_skeletons.txt -o ntu\n"
        "  actformer ingest ntu raw/ -o ntu --strict\n"
        "An interrupted run goes on where it was when the same command is given again.\n");
    command->callback([options] {
        std::unordered_set<std::string> missing;
        if (!options->missing.empty()) missing = ingest::read_missing_list(options->missing);
        run_ingest(*options, ingest::NtuFormat(), false, std::move(missing));
    });
}

}  // namespace actformer::cli
