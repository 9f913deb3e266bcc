// libFuzzer: any bytes as the pickles of NTURecon, NTU-13, HumanAct12 and UESTC. Whatever they hold, clips or rejections of one line come
// of them, and clips hold as many numbers as they say.
#include <algorithm>
#include <cstdlib>
#include <memory>

#include "ingest/formats/humanact12/humanact12_format.hpp"
#include "ingest/formats/motions/position_clips.hpp"
#include "ingest/formats/ntu13/ntu13_format.hpp"
#include "ingest/formats/nturecon/nturecon_format.hpp"
#include "ingest/formats/uestc/uestc_format.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer;
using namespace actformer::ingest;
using namespace actformer::fuzzing;

namespace {

class Checking : public ClipSink {
  public:
    explicit Checking(const DatasetHeader& header) : header_(header) {}

    void take(ParsedClip clip) override {
        if (const auto* rejection = std::get_if<Rejection>(&clip)) {
            demand_one_line(rejection->reason);
            return;
        }
        const auto& made = *std::get<0>(clip);
        demand(made.label < header_.classes.size() && made.fields.size() == header_.fields.size());
        if (const auto* rotations = dynamic_cast<const RotationalClip*>(&made))
            demand(rotations->frames > 0 &&
                   rotations->values.size() == rotations->frames * header_.frame_values());
        if (const auto* positions = dynamic_cast<const PositionClip*>(&made))
            demand(positions->frames > 0 &&
                   positions->values.size() == positions->frames * header_.frame_values());
    }

  private:
    const DatasetHeader& header_;
};

void read(Format& format, std::string_view path, std::string_view text) {
    const auto stem = path.substr(0, path.rfind('.'));
    const RawText pickle{path, stem, text, path};
    format.survey({path, stem, {}, path});
    format.settle();
    Checking sink(format.datasets()[0]);
    format.read(pickle, sink);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const Input input(data, size);
    const auto text = input.text();

    NtuReconFormat nturecon("x", {});
    read(nturecon, "S001C001P001R001A001_body0.pkl", text);
    Ntu13Format rotations({"x", false, {}, false}), joints({"x", true, {}, false});
    read(rotations, "S001C001P001R001A099.pkl", text);
    read(joints, "S001C001P001R001A099.pkl", text);
    HumanAct12Format act12({"x", HumanAct12Options::From::rotations, {}, 30, false});
    read(act12, "humanact12poses.pkl", text);
    UestcFormat uestc("x", {});
    for (const auto& [path, lines] : {std::pair{"names.txt", "a0_d2_p001_c2_color.avi\n"},
                                      {"num_frames_min.txt", "2\n"},
                                      {"action_classes.txt", "squat\n"}})
        uestc.survey(
            {path, std::string_view(path).substr(0, std::string_view(path).rfind('.')), lines, path});
    read(uestc, "vibe_cache_refined.pkl", text);
    return 0;
}
