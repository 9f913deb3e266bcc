#include "ingest/formats/babel/amass_file.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/numpy/npz.hpp"

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

class Reader {
  public:
    AmassFile read(std::string_view bytes) {
        NpzSelection selection;
        selection.largest = largest_array;
        selection.wanted = [this](const std::string& name) {
            marked_smplx_ = marked_smplx_ || name == "surface_model_type" || name == "pose_jaw";
            return name == "poses" || name == "trans" || name == "mocap_framerate" ||
                   name == "mocap_frame_rate";
        };
        read_npz(bytes, selection, [this](const std::string& name, const NumpyArray& array) {
            if (name == "poses")
                read_poses(array);
            else if (name == "trans")
                read_translation(array);
            else
                read_rate(name, array);
        });
        check();
        return std::move(out_);
    }

  private:
    /// The first `taken` numbers of every frame of an array (frames, numbers).
    static std::vector<double> columns(const NumpyArray& array, std::uint64_t taken) {
        const auto frames = array.shape[0], numbers = array.shape[1];
        std::vector<double> out(frames * taken);
        for (std::uint64_t t = 0; t < frames; ++t) {
            const auto first = array.fortran_order ? t : t * numbers;
            array.copy(first, array.fortran_order ? frames : 1, taken, &out[t * taken]);
        }
        return out;
    }

    void read_poses(const NumpyArray& array) {
        const auto layout = std::find_if(std::begin(layouts), std::end(layouts), [&](const Layout& one) {
            return array.shape.size() == 2 && array.numbers() && array.shape[1] == one.numbers;
        });
        if (layout == std::end(layouts))
            throw Error(
                "'poses' is {} of type {}; SMPL+H has (frames, 156), SMPL-X (frames, 165), SMPL (frames, 72)",
                array.shape_text(), array.type);
        out_.frames = array.shape[0];
        out_.joints = layout->joints;
        out_.smplx = layout->smplx;
        out_.vectors = columns(array, 3 * layout->joints);
        has_poses_ = true;
    }

    void read_translation(const NumpyArray& array) {
        if (array.shape.size() != 2 || array.shape[1] != 3 || !array.numbers())
            throw Error("'trans' is {} of type {}, not (frames, 3)", array.shape_text(), array.type);
        out_.translation = columns(array, 3);
        has_translation_ = true;
    }

    void read_rate(const std::string& name, const NumpyArray& array) {
        if (array.elements() != 1 || !array.numbers())
            throw Error("'{}' is {} of type {}, not one number", name, array.shape_text(), array.type);
        marked_smplx_ = marked_smplx_ || name == "mocap_frame_rate";
        out_.fps = array.all_numbers()[0];
        if (!(out_.fps >= 1 && out_.fps <= 10000))
            throw Error("'{}' is {}, no number of frames a second", name, out_.fps);
    }

    void check() {
        out_.smplx = out_.smplx || marked_smplx_;
        if (!has_poses_) throw Error("no 'poses' in it: no recording of AMASS{}", remedy());
        if (!has_translation_) throw Error("no 'trans' in it: no recording of AMASS{}", remedy());
        if (out_.fps == 0)
            throw Error("no 'mocap_framerate' in it: no recording of AMASS's package SMPL+H G{}", remedy());
        if (out_.translation.size() != out_.frames * 3)
            throw Error("'trans' has {} frames and 'poses' {}", out_.translation.size() / 3, out_.frames);
        if (out_.frames == 0) throw Error("'poses' has no frames");
    }

    std::string remedy() const {
        return out_.smplx || marked_smplx_ ? fmt::format(" ({})", other_package) : "";
    }

    AmassFile out_;
    bool has_poses_ = false, has_translation_ = false, marked_smplx_ = false;
};

}  // namespace

RotationVectors AmassFile::rotation_vectors() const {
    return {frames, joints, [this](std::uint64_t frame, double* to, double* place) {
                std::copy_n(&vectors[frame * joints * 3], joints * 3, to);
                std::copy_n(&translation[frame * 3], 3, place);
            }};
}

AmassFile read_amass_file(std::string_view bytes) {
    return Reader().read(bytes);
}

bool holds_no_motion(std::string_view stem) {
    return stem == "shape" || stem.ends_with("_shape") || stem.ends_with("stagei");
}

}  // namespace actformer::ingest
