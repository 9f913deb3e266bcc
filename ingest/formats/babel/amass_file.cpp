#include "ingest/formats/babel/amass_file.hpp"

#include <algorithm>
#include <vector>

#include "base/error.hpp"
#include "base/numpy/npz.hpp"
#include "base/text/html.hpp"

namespace actformer::ingest {
namespace {

constexpr std::uint64_t largest_array = std::uint64_t{1} << 30;
constexpr std::string_view other_package = "this is the SMPL-X package; take SMPL+H G";

/// Numbers a frame of the packages, and how many of the joints are SMPL's.
struct Layout {
    std::uint64_t numbers;
    std::size_t joints;
    bool smplx;
};
constexpr Layout layouts[]{{156, 22, false}, {165, 22, true}, {72, 24, false}};  // SMPL+H, SMPL-X, SMPL

/// What is known before the rotations themselves are read.
struct Head {
    const Layout* layout = nullptr;   ///< of `poses`; null: there are none
    std::uint64_t frames = 0;         ///< of `poses`
    std::vector<double> translation;  ///< (frames, 3)
    bool has_translation = false, smplx = false;
    double fps = 0;
};

/// `count` numbers of row `t` of an array (rows, numbers).
void read_row(const NumpyArray& array, std::uint64_t t, std::uint64_t count, double* to) {
    const auto rows = array.shape[0], numbers = array.shape[1];
    if (array.fortran_order)
        array.copy(t, rows, count, to);
    else
        array.copy(t * numbers, 1, count, to);
}

void read_translation(const NumpyArray& array, Head& head) {
    if (array.shape.size() != 2 || array.shape[1] != 3 || !array.numbers())
        throw Error("{} of type {}, not (frames, 3)", array.shape_text(), array.type);
    head.translation.resize(array.shape[0] * 3);
    for (std::uint64_t t = 0; t < array.shape[0]; ++t) read_row(array, t, 3, &head.translation[3 * t]);
    head.has_translation = true;
}

void read_rate(const NumpyArray& array, Head& head) {
    if (array.elements() != 1 || !array.numbers())
        throw Error("{} of type {}, not one number", array.shape_text(), array.type);
    head.fps = array.all_numbers()[0];
    if (!(head.fps >= 1 && head.fps <= 10000)) throw Error("{}, no number of frames a second", head.fps);
}

void read_layout(const NumpyArray& poses, Head& head) {
    for (const auto& one : layouts)
        if (poses.shape.size() == 2 && poses.numbers() && poses.shape[1] == one.numbers) head.layout = &one;
    if (!head.layout)
        throw Error("{} of type {}; SMPL+H has (frames, 156), SMPL-X (frames, 165), SMPL (frames, 72)",
                    poses.shape_text(), poses.type);
    head.frames = poses.shape[0];
    head.smplx = head.smplx || head.layout->smplx;
}

NpzSelection only(std::function<bool(const std::string&)> wanted) {
    NpzSelection selection;
    selection.largest = largest_array;
    selection.wanted = std::move(wanted);
    return selection;
}

Head read_head(std::string_view bytes) {
    Head head;
    auto poses = only([&](const std::string& name) {
        head.smplx =
            head.smplx || name == "surface_model_type" || name == "pose_jaw" || name == "mocap_frame_rate";
        return name == "poses";
    });
    poses.heads_only = true;
    read_npz(bytes, poses, [&](const std::string&, const NumpyArray& array) { read_layout(array, head); });
    const auto others = only([](const std::string& name) {
        return name == "trans" || name == "mocap_framerate" || name == "mocap_frame_rate";
    });
    read_npz(bytes, others, [&](const std::string& name, const NumpyArray& array) {
        name == "trans" ? read_translation(array, head) : read_rate(array, head);
    });
    return head;
}

void check(const Head& head) {
    const auto lacks = [&](const char* what) {
        throw Error("no '{}' in it: no recording of AMASS's package SMPL+H G{}", what,
                    head.smplx ? fmt::format(" ({})", other_package) : "");
    };
    if (!head.layout) lacks("poses");
    if (!head.has_translation) lacks("trans");
    if (head.fps == 0) lacks("mocap_framerate");
    if (head.translation.size() != head.frames * 3)
        throw Error("'trans' has {} frames and 'poses' {}", head.translation.size() / 3, head.frames);
    if (head.frames == 0) throw Error("'poses' has no frames");
}

}  // namespace

void read_amass_file(std::string_view bytes, const std::function<void(const AmassRecording&)>& use) {
    if (is_html(bytes)) throw Error("{}", html_in_place_of("a recording"));
    const auto head = read_head(bytes);
    check(head);
    const auto joints = head.layout->joints;
    const auto poses = only([](const std::string& name) { return name == "poses"; });
    read_npz(bytes, poses, [&](const std::string&, const NumpyArray& array) {
        if (!array.numbers() || array.shape != std::vector{head.frames, head.layout->numbers})
            throw Error("two arrays of this name, of different shapes: damaged");
        const auto read = [&](std::uint64_t t, double* vectors, double* place) {
            read_row(array, t, 3 * joints, vectors);
            std::copy_n(&head.translation[3 * t], 3, place);
        };
        use({{head.frames, joints, read}, head.fps, head.smplx});
    });
}

bool holds_no_motion(std::string_view stem) {
    return stem == "shape" || stem.ends_with("_shape") || stem.ends_with("stagei");
}

}  // namespace actformer::ingest
