// Meshes and bodies as pictures: what is drawn where, and what hides what.
#include "reports/pictures/mesh.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "reports/motions/gather.hpp"
#include "reports/pictures/draw.hpp"
#include "tests/support/made_body.hpp"
#include "tests/support/temp_dir.hpp"
#include "tests/support/turning_motion.hpp"

using namespace actformer;
using namespace actformer::reports;
using namespace actformer::test;

namespace {

const cv::Vec3f paper(255, 255, 255), red(0, 0, 255), blue(255, 0, 0);

cv::Mat empty_picture(int width, int height) {
    return {height, width, CV_8UC3, cv::Scalar(255, 255, 255)};
}

MeshCorner corner(double x, double y, double nearness, const cv::Vec3f& colour) {
    return {{x, y, nearness}, {0, 0, 1}, colour};
}

bool is_paper(const cv::Vec3b& pixel) {
    return pixel == cv::Vec3b(255, 255, 255);
}

std::filesystem::path body_file(const TempDir& folder) {
    write_body(folder / "body.npz", made_body(8, 8));
    return folder / "body.npz";
}

}  // namespace

TEST(Mesh, FillsItsTriangleAndNothingElse) {
    auto picture = empty_picture(40, 30);
    // The lower left half of a square from (10, 5) to (30, 25).
    draw_mesh(picture, {corner(10, 5, 0, red), corner(10, 25, 0, red), corner(30, 25, 0, red)},
              std::vector<std::uint32_t>{0, 1, 2}, 3, paper);
    double covered = 0;
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            const bool inside = x >= 10 && y < 25 && x - 10 < y - 5;
            const bool beyond = x < 10 || y >= 25 || x - 10 > y - 5;
            const auto pixel = picture.at<cv::Vec3b>(y, x);
            if (inside || beyond) {
                EXPECT_EQ(is_paper(pixel), beyond) << x << " " << y;
            }
            covered += (255 - pixel[1]) / 255.0;  // green: the colour has next to none of it
        }
    EXPECT_NEAR(covered, 200, 25);  // the light's gleam takes up to a tenth
}

TEST(Mesh, NearerHidesFarther) {
    const std::vector<std::uint32_t> faces{0, 1, 2, 3, 4, 5};
    for (const double nearer : {-1.0, 1.0}) {
        auto picture = empty_picture(20, 20);
        draw_mesh(picture,
                  {corner(0, 0, 0, red), corner(19, 0, 0, red), corner(0, 19, 0, red),
                   corner(0, 0, nearer, blue), corner(19, 0, nearer, blue), corner(0, 19, nearer, blue)},
                  faces, 2, paper);
        const auto pixel = picture.at<cv::Vec3b>(4, 4);
        EXPECT_EQ(pixel[0] > pixel[2], nearer > 0);
    }
}

// What turns away from the viewer is the back of what faces it; what turns aside is darker.
TEST(Mesh, IsLitByItsNormals) {
    const auto drawn = [](const cv::Vec3f& normal) {
        auto picture = empty_picture(20, 20);
        std::vector<MeshCorner> corners;
        for (const auto& [x, y] : {std::pair{0, 0}, {0, 19}, {19, 0}})
            corners.push_back({{static_cast<double>(x), static_cast<double>(y), 0}, normal, red});
        draw_mesh(picture, corners, std::vector<std::uint32_t>{0, 1, 2}, 2, paper);
        return picture.at<cv::Vec3b>(4, 4);
    };
    EXPECT_EQ(drawn({0, 0, 1}), drawn({0, 0, -1}));
    EXPECT_GT(drawn({-0.38F, -0.55F, 0.744F})[2], drawn({0.7F, 0.7F, 0.14F})[2]);
}

TEST(BodyPictureOnDevice, TheWholeBodyIsInsideItsCellAndCoversItsJoints) {
    const TempDir folder;
    write_turning_motion(folder / "walk.h5", 24, 2);
    Wanted wanted;
    wanted.body = std::make_shared<const BodySkin>(body_file(folder));
    const auto motions = gather(folder / "walk.h5", wanted);
    ASSERT_EQ(motions.size(), 1U);
    ASSERT_TRUE(motions[0].skin);
    const Stage stage(motions[0], View{0, 0, false});  // level: no floor is drawn
    for (const std::size_t frame : {0U, 9U, 23U}) {
        const cv::Size size(200, 160);
        auto cell = empty_picture(size.width, size.height);
        stage.draw(cell, frame);
        for (int y = 0; y < size.height; ++y)
            for (const int x : {0, 1, size.width - 2, size.width - 1})
                EXPECT_TRUE(is_paper(cell.at<cv::Vec3b>(y, x)));
        for (int x = 0; x < size.width; ++x)
            for (const int y : {0, size.height - 1}) EXPECT_TRUE(is_paper(cell.at<cv::Vec3b>(y, x)));
        const auto camera = stage.camera(frame, size);
        for (std::size_t p = 0; p < 2; ++p)
            for (std::size_t j = 0; j < 24; ++j) {
                const float* at = motions[0].at(frame, p, j);
                const auto seen = camera.project({at[0], at[1], at[2]});
                EXPECT_FALSE(is_paper(cell.at<cv::Vec3b>(static_cast<int>(seen.y), static_cast<int>(seen.x))))
                    << "frame " << frame << ", person " << p << ", joint " << j;
            }
    }
}

TEST(BodyPictureOnDevice, IsForRotationsAlone) {
    const TempDir folder;
    Wanted wanted;
    wanted.body = std::make_shared<const BodySkin>(body_file(folder));
    ingest::Motion limbs{"A001_0", 3, 1, 25, 3, std::vector<float>(3 * 25 * 3, 0.0F)};
    for (std::size_t i = 0; i < limbs.values.size(); i += 3) limbs.values[i] = 1;
    ingest::MotionsWriter file(folder / "limbs.h5");
    file.add("A001_0", limbs);
    file.finish();
    for (const auto* name : {"limbs.h5", "raw.skeleton"}) {
        if (std::string(name) == "raw.skeleton") write_file(folder / name, "1\n0\n");
        try {
            gather(folder / name, wanted);
            ADD_FAILURE() << name;
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find("leave --body out"), std::string::npos) << e.what();
        }
    }
}
