#include "ingest/formats/humanact12/humanact12_command.hpp"

#include "base/error.hpp"
#include "ingest/formats/humanact12/humanact12_format.hpp"

namespace actformer::ingest {

std::vector<Option> HumanAct12Command::list() {
    auto options = rotations.list();
    options.push_back(Option("--from",
                             "What becomes the dataset: SMPL's rotations, or its 24 joints (default: "
                             "rotations where there is a .pkl "
                             "file, else joints)",
                             "WHAT", &from)
                          .one_of({"rotations", "joints"}));
    options.push_back(
        Option("--fps", "Frames a second to tell: 30 as published; the cameras took 15, HumanML3D has 20",
               "F", &fps)
            .with_default());
    options.emplace_back(
        "--published",
        "The camera's frame, y down, as the public tools and the recognisers trained with them have it", "",
        &published);
    return options;
}

std::unique_ptr<Format> HumanAct12Command::open(const std::string& dataset) const {
    if (!(fps >= 1 && fps <= 1000)) throw Error("{} frames a second; give 1 to 1000", fps);
    using From = HumanAct12Options::From;
    const auto source = from.empty() ? From::files : from == "joints" ? From::joints : From::rotations;
    return std::make_unique<HumanAct12Format>(
        HumanAct12Options{dataset, source, rotations.target(), fps, published});
}

}  // namespace actformer::ingest
