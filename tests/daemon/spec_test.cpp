#include "daemon/spec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hydroprint/v1/error_reason.pb.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {
namespace {

const std::string kAsset = "assets/" + std::string(64, 'a');

void set_file(v1::InputFile& file, const std::string& name) {
  file.set_name(name);
  file.set_asset(kAsset);
}

v1::Job job_with_mesh() {
  v1::Job job;
  set_file(*job.mutable_simulate()->mutable_mesh(), "spot.obj");
  return job;
}

std::string refused_field(const v1::Job& job) {
  const auto made = check_job(job);
  if (made) return "accepted";
  EXPECT_EQ(made.error().code, Code::kInvalidArgument);
  const auto& metadata = made.error().metadata;
  return metadata.contains("field") ? metadata.at("field") : made.error().reason;
}

TEST(Spec, EveryFieldBecomesItsFlag) {
  v1::Job job = job_with_mesh();
  auto& spec = *job.mutable_simulate();
  set_file(*spec.mutable_texture(), "textures/spot.png");
  set_file(*spec.add_extra_files(), "film.json");
  set_file(*spec.mutable_profile(), "p.toml");
  set_file(*spec.mutable_ink_image(), "ink.png");
  spec.set_scale(50);
  spec.set_film("polygon:film.json");
  spec.set_dpi(600.5);
  spec.set_model(v1::MODEL_STOKES);
  spec.set_ink_passes(0);
  spec.set_depth_mm(12.25);
  spec.set_dip_speed_mm_per_s(0.1);
  spec.set_threads(4);
  spec.set_artifacts(v1::ARTIFACT_SET_MAP);
  const auto made = check_job(job);
  ASSERT_TRUE(made) << made.error().message;
  auto flags = made->work.flags;
  std::sort(flags.begin(), flags.end());
  EXPECT_EQ(flags, (std::vector<std::string>{
                       "--artifacts=map", "--depth-mm=12.25", "--dip-speed-mm-per-s=0.1",
                       "--dpi=600.5", "--film=polygon:film.json", "--ink-image=ink.png",
                       "--ink-passes=0", "--mesh=spot.obj", "--model=stokes", "--profile=p.toml",
                       "--scale=50", "--texture=textures/spot.png"}));
  EXPECT_EQ(made->threads, 4);
  EXPECT_EQ(made->work.inputs.size(), 5U);
  EXPECT_EQ(made->display_name, "simulate spot.obj");
}

TEST(Spec, UnsetFieldsLeaveTheirFlagsOut) {
  const auto made = check_job(job_with_mesh());
  ASSERT_TRUE(made);
  EXPECT_EQ(made->work.flags, std::vector<std::string>{"--mesh=spot.obj"});
  EXPECT_TRUE(made->work.pose_json.empty());
}

template <class SpecOfAVerb>
void expect_inertia_for_the_sheet_alone(v1::Job& job, SpecOfAVerb& spec, const std::string& field) {
  const auto has_flag = [&] {
    const auto made = check_job(job);
    EXPECT_TRUE(made) << made.error().message;
    return made && std::count(made->work.flags.begin(), made->work.flags.end(), "--inertia") == 1;
  };
  EXPECT_FALSE(has_flag());
  spec.set_inertia(true);
  EXPECT_TRUE(has_flag()) << "the worker's default is the sheet";
  spec.set_model(v1::MODEL_SHEET);
  EXPECT_TRUE(has_flag());
  spec.set_model(v1::MODEL_STOKES);
  EXPECT_EQ(refused_field(job), field);
  spec.set_inertia(false);
  EXPECT_FALSE(has_flag());
}

TEST(Spec, InertiaGoesWithTheSheetAlone) {
  v1::Job simulate = job_with_mesh();
  expect_inertia_for_the_sheet_alone(simulate, *simulate.mutable_simulate(), "simulate.inertia");
  v1::Job predict;
  set_file(*predict.mutable_predict()->mutable_mesh(), "spot.obj");
  set_file(*predict.mutable_predict()->mutable_film_image(), "film.png");
  expect_inertia_for_the_sheet_alone(predict, *predict.mutable_predict(), "predict.inertia");
}

TEST(Spec, PoseBecomesTheFileOfTheContract) {
  v1::Job job = job_with_mesh();
  auto& pose = *job.mutable_simulate()->mutable_pose();
  for (const double x : {0.0, 0.0, 0.6, 0.8}) pose.add_rotation_wxyz(x);
  for (const double x : {1.5, -2.0, 0.0}) pose.add_translation_mm(x);
  EXPECT_EQ(check_job(job)->work.pose_json,
            R"({"rotation_wxyz":[0,0,0.6,0.8],"translation_mm":[1.5,-2,0]})");
}

TEST(Spec, PredictHasItsOwnFiles) {
  v1::Job job;
  set_file(*job.mutable_predict()->mutable_mesh(), "spot.obj");
  EXPECT_EQ(refused_field(job), "predict.film_image");
  set_file(*job.mutable_predict()->mutable_film_image(), "film.png");
  set_file(*job.mutable_predict()->mutable_motion(), "path.csv");
  const auto made = check_job(job);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->work.verb, "predict");
  EXPECT_EQ(made->work.flags, (std::vector<std::string>{"--mesh=spot.obj", "--film-image=film.png",
                                                        "--motion=path.csv"}));
}

TEST(Spec, FitHasPointsAndNamesWhatIsFree) {
  v1::Job job;
  auto& spec = *job.mutable_fit();
  set_file(*spec.mutable_mesh(), "ball.ply");
  EXPECT_EQ(refused_field(job), "fit.points");
  set_file(*spec.mutable_points(), "measured.csv");
  set_file(*spec.mutable_ink_image(), "film.png");
  spec.set_film("circle:80");
  spec.set_depth_mm(40);
  spec.add_free("drag");
  spec.add_free("ink_ratio");
  spec.set_drop_outliers(true);
  spec.set_threads(2);
  const auto made = check_job(job);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->work.verb, "fit");
  EXPECT_EQ(made->work.flags,
            (std::vector<std::string>{"--mesh=ball.ply", "--film=circle:80", "--ink-image=film.png",
                                      "--depth-mm=40", "--points=measured.csv",
                                      "--free=drag,ink_ratio", "--drop-outliers"}));
  EXPECT_EQ(made->work.inputs.size(), 3U);
  EXPECT_EQ(made->threads, 2);
  EXPECT_EQ(made->display_name, "fit ball.ply");

  for (const char* bad : {"", "a,b", "--out=x", "Drag", "ink-ratio"}) {
    spec.set_free(0, bad);
    EXPECT_EQ(refused_field(job), "fit.free") << bad;
  }
  spec.set_free(0, "drag");
  spec.set_depth_mm(-1);
  EXPECT_EQ(refused_field(job), "fit.depth_mm");
}

TEST(Spec, ValidateNeedsNoFiles) {
  v1::Job job;
  auto& spec = *job.mutable_validate();
  auto made = check_job(job);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->work.verb, "validate");
  EXPECT_TRUE(made->work.flags.empty());
  EXPECT_TRUE(made->work.inputs.empty());
  EXPECT_EQ(made->display_name, "validate");

  spec.add_only("accuracy");
  spec.add_only("cat-bowl");
  spec.set_quick(true);
  spec.set_threads(3);
  made = check_job(job);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->work.flags, (std::vector<std::string>{"--only=accuracy,cat-bowl", "--quick"}));
  EXPECT_EQ(made->threads, 3);

  for (const char* bad : {"", "a,b", "--out=x", "Accuracy", "a b"}) {
    spec.set_only(0, bad);
    EXPECT_EQ(refused_field(job), "validate.only") << bad;
  }
  spec.set_only(0, "accuracy");
  for (int i = 0; i < 40; ++i) spec.add_only("more");
  EXPECT_EQ(refused_field(job), "validate.only");
  spec.clear_only();
  spec.set_threads(0);
  EXPECT_EQ(refused_field(job), "validate.threads");
}

v1::Job print_image_job() {
  v1::Job job;
  set_file(*job.mutable_print_image()->mutable_film_image(), "film.png");
  return job;
}

TEST(Spec, EveryFieldOfPrintImageBecomesItsFlag) {
  v1::Job job;
  auto& spec = *job.mutable_print_image();
  EXPECT_EQ(refused_field(job), "print_image.film_image");
  set_file(*spec.mutable_film_image(), "film.png");
  set_file(*spec.mutable_icc_profile(), "printer.icc");
  set_file(*spec.add_extra_files(), "film.json");
  spec.set_film("polygon:film.json");
  spec.set_dpi(600.5);
  spec.set_threads(2);
  spec.set_paper("A3");
  spec.set_printer_margin_mm(0);
  spec.set_job_name("--out=mug 7");
  spec.set_date("2025-03-14");
  spec.set_bar_mm(40);
  spec.set_overlap_mm(15);
  spec.set_mirror(true);
  spec.set_no_marks(true);
  spec.set_colours(v1::COLOURS_CMYK);
  spec.set_ink_limit(2.5);
  spec.add_formats("pdf");
  spec.add_formats("tiff");
  const auto made = check_job(job);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->work.verb, "print-image");
  auto flags = made->work.flags;
  std::sort(flags.begin(), flags.end());
  EXPECT_EQ(flags, (std::vector<std::string>{
                       "--bar-mm=40", "--colours=cmyk", "--date=2025-03-14", "--dpi=600.5",
                       "--film-image=film.png", "--film=polygon:film.json", "--formats=pdf,tiff",
                       "--icc-profile=printer.icc", "--ink-limit=2.5", "--job-name=--out=mug 7",
                       "--mirror", "--no-marks", "--overlap-mm=15", "--paper=A3",
                       "--printer-margin-mm=0"}));
  EXPECT_EQ(made->threads, 2);
  EXPECT_EQ(made->work.inputs.size(), 3U);
  EXPECT_EQ(made->display_name, "print-image film.png");
}

TEST(Spec, PrintImageIsRefusedWhatThePrinterCannotHave) {
  const auto refused = [](const auto& change) {
    v1::Job job = print_image_job();
    change(*job.mutable_print_image());
    return refused_field(job);
  };
  for (const double bad : {-1.0, 5000.0, std::nan("")}) {
    EXPECT_EQ(refused([&](auto& spec) { spec.set_printer_margin_mm(bad); }),
              "print_image.printer_margin_mm");
    EXPECT_EQ(refused([&](auto& spec) { spec.set_bar_mm(bad); }), "print_image.bar_mm");
    EXPECT_EQ(refused([&](auto& spec) { spec.set_overlap_mm(bad); }), "print_image.overlap_mm");
    EXPECT_EQ(refused([&](auto& spec) { spec.set_ink_limit(bad); }), "print_image.ink_limit");
  }
  EXPECT_EQ(refused([](auto& spec) { spec.set_colours(static_cast<v1::Colours>(9)); }),
            "print_image.colours");
  EXPECT_EQ(refused([](auto& spec) { spec.add_formats("pdf,png"); }), "print_image.formats");
  EXPECT_EQ(refused([](auto& spec) { spec.set_job_name("a\nb"); }), "print_image.job_name");
  EXPECT_EQ(refused([](auto& spec) { spec.set_date(std::string(201, '1')); }), "print_image.date");
  EXPECT_EQ(refused([](auto& spec) { spec.set_paper("A4\n--out=/"); }), "print_image.paper");
}

TEST(Spec, TemplateTakesObjectFilmAndPaper) {
  v1::Job job;
  auto& spec = *job.mutable_template_();
  spec.set_scale(10);
  EXPECT_EQ(refused_field(job), "template.mesh");
  set_file(*spec.mutable_mesh(), "mug.obj");
  spec.set_film("A3");
  spec.set_paper("A3");
  spec.set_date("today");
  const auto made = check_job(job);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->work.verb, "template");
  EXPECT_EQ(made->work.flags, (std::vector<std::string>{"--mesh=mug.obj", "--scale=10", "--film=A3",
                                                        "--paper=A3", "--date=today"}));
  EXPECT_EQ(made->display_name, "template mug.obj");
}

TEST(Spec, ResolutionIsWhatTheWorkerTakes) {
  for (const double dpi : {20.0, 2400.0, 19.9, 2400.1}) {
    v1::Job job = job_with_mesh();
    job.mutable_simulate()->set_dpi(dpi);
    EXPECT_EQ(check_job(job).has_value(), dpi >= 20 && dpi <= 2400) << dpi;
  }
}

TEST(Spec, NumbersThatAreNoneOrOutOfRangeAreRefused) {
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    v1::Job job = job_with_mesh();
    job.mutable_simulate()->set_dpi(bad);
    EXPECT_EQ(refused_field(job), "simulate.dpi");
    job = job_with_mesh();
    job.mutable_simulate()->set_scale(bad);
    EXPECT_EQ(refused_field(job), "simulate.scale");
    job = job_with_mesh();
    job.mutable_simulate()->set_depth_mm(bad);
    EXPECT_EQ(refused_field(job), "simulate.depth_mm");
  }
  v1::Job job = job_with_mesh();
  job.mutable_simulate()->set_threads(0);
  EXPECT_EQ(refused_field(job), "simulate.threads");
  job = job_with_mesh();
  job.mutable_simulate()->set_model(static_cast<v1::Model>(77));
  EXPECT_EQ(refused_field(job), "simulate.model");
  job = job_with_mesh();
  job.set_priority(10);
  EXPECT_EQ(refused_field(job), "priority");
}

TEST(Spec, PosesThatAreNoneAreRefused) {
  v1::Job job = job_with_mesh();
  auto& pose = *job.mutable_simulate()->mutable_pose();
  EXPECT_EQ(refused_field(job), "simulate.pose.rotation_wxyz");
  for (int i = 0; i < 4; ++i) pose.add_rotation_wxyz(i == 0 ? std::nan("") : 0);
  for (int i = 0; i < 3; ++i) pose.add_translation_mm(0);
  EXPECT_EQ(refused_field(job), "simulate.pose.rotation_wxyz");
  pose.set_rotation_wxyz(0, 2);
  EXPECT_EQ(refused_field(job), "simulate.pose.rotation_wxyz");
  pose.set_rotation_wxyz(0, 1);
  EXPECT_EQ(refused_field(job), "accepted");
  pose.add_translation_mm(0);
  EXPECT_EQ(refused_field(job), "simulate.pose.translation_mm");
}

v1::Job calibrate_job() {
  v1::Job job;
  set_file(*job.mutable_calibrate()->mutable_mesh(), "spot.obj");
  set_file(*job.mutable_calibrate()->mutable_layout(), "layout.toml");
  set_file(*job.mutable_calibrate()->add_frames(), "frames/frames.json");
  set_file(*job.mutable_calibrate()->add_frames(), "frames/1.png");
  return job;
}

TEST(Spec, FieldsOfCalibrateBecomeItsFlags) {
  v1::Job job = calibrate_job();
  job.mutable_calibrate()->set_gripper_mm(-2.5);
  set_file(*job.mutable_calibrate()->mutable_camera(), "camera.json");
  const auto made = check_job(job);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_FALSE(made->use_cache);
  EXPECT_EQ(made->work.inputs.size(), 5U);
  EXPECT_EQ(made->work.flags,
            (std::vector<std::string>{"--mesh=spot.obj", "--frames=frames", "--layout=layout.toml",
                                      "--camera=camera.json", "--gripper-mm=-2.5"}));
  job = calibrate_job();
  set_file(*job.mutable_calibrate()->add_frames(), "other/frames.json");
  EXPECT_EQ(refused_field(job), "calibrate.frames") << "one view";
  job.mutable_calibrate()->clear_frames();
  EXPECT_EQ(refused_field(job), "calibrate.frames");
  job = calibrate_job();
  job.mutable_calibrate()->clear_layout();
  EXPECT_EQ(refused_field(job), "calibrate.layout");
  job = calibrate_job();
  job.mutable_calibrate()->set_gripper_mm(std::nan(""));
  EXPECT_EQ(refused_field(job), "calibrate.gripper_mm");
}

TEST(Spec, EachViewOfTheBoardIsAFolder) {
  v1::Job job;
  for (const char* name : {"a/frames.json", "a/1.png", "b/c/frames.json"})
    set_file(*job.mutable_calibrate_camera()->add_frames(), name);
  EXPECT_EQ(check_job(job)->work.flags, (std::vector<std::string>{"--frames=a", "--frames=b/c"}));
  EXPECT_EQ(check_job(job)->work.verb, "calibrate-camera");
  EXPECT_EQ(check_job(job)->display_name, "calibrate-camera of 2 views");
  set_file(*job.mutable_calibrate_camera()->add_frames(), "a/1.png");
  EXPECT_EQ(refused_field(job), "NAME_INVALID");
}

TEST(Spec, ACaptureIsShortEnoughToBeKept) {
  v1::Job job;
  job.mutable_capture()->set_seconds(20);
  EXPECT_EQ(refused_field(job), "accepted");
  for (const double wrong : {0.0, 20.1, std::nan("")}) {
    job.mutable_capture()->set_seconds(wrong);
    EXPECT_EQ(refused_field(job), "capture.seconds");
  }
}

TEST(Spec, HostileNamesAndTextsAreRefused) {
  v1::Job job = job_with_mesh();
  job.mutable_simulate()->mutable_mesh()->set_name("../../etc/passwd");
  EXPECT_EQ(refused_field(job), "simulate.mesh.name");
  job = job_with_mesh();
  job.mutable_simulate()->mutable_mesh()->set_asset("assets/../x");
  EXPECT_EQ(refused_field(job), "ID_INVALID");
  job = job_with_mesh();
  set_file(*job.mutable_simulate()->mutable_texture(), "spot.obj");
  EXPECT_EQ(refused_field(job), "NAME_INVALID") << "the same name twice";
  job = job_with_mesh();
  set_file(*job.mutable_simulate()->mutable_texture(), "spot.obj/a.png");
  EXPECT_EQ(refused_field(job), "NAME_INVALID") << "a file as a folder";
  job = job_with_mesh();
  job.mutable_simulate()->set_film("A4\n--out=/");
  EXPECT_EQ(refused_field(job), "simulate.film");
  job.mutable_simulate()->set_film("polygon:/etc/passwd");
  EXPECT_EQ(refused_field(job), "simulate.film");
  job = job_with_mesh();
  job.set_display_name("a\x1b[2J");
  EXPECT_EQ(refused_field(job), "display_name");
  job = job_with_mesh();
  (*job.mutable_labels())["k"] = std::string(201, 'x');
  EXPECT_EQ(refused_field(job), "labels");
  EXPECT_EQ(refused_field(v1::Job()), "job");
}

TEST(Digest, DependsOnAllThatMattersAndOnNothingElse) {
  v1::Job job = job_with_mesh();
  const std::string digest = input_digest(check_job(job)->work, "w");
  job.set_display_name("other");
  job.mutable_simulate()->set_threads(3);
  EXPECT_EQ(input_digest(check_job(job)->work, "w"), digest);
  EXPECT_NE(input_digest(check_job(job)->work, "v"), digest);
  job.mutable_simulate()->set_dpi(301);
  EXPECT_NE(input_digest(check_job(job)->work, "w"), digest);
  job = job_with_mesh();
  job.mutable_simulate()->set_inertia(true);
  EXPECT_NE(input_digest(check_job(job)->work, "w"), digest);
  job = job_with_mesh();
  job.mutable_simulate()->mutable_mesh()->set_asset("assets/" + std::string(64, 'b'));
  EXPECT_NE(input_digest(check_job(job)->work, "w"), digest);
}

}  // namespace
}  // namespace hydroprint::daemon
