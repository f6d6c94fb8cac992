#include "daemon/jobs/job_request.h"

#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "daemon/rest/bad_request.h"
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
  const auto request = check_job(job);
  if (request) return "accepted";
  EXPECT_EQ(request.error().code, Code::kInvalidArgument);
  const Error& error = request.error();
  return error.field.empty() ? std::string(name_of(error.reason)) : error.field;
}

/// The spec that the worker receives.
template <class SpecOfAKind>
SpecOfAKind given(const NewJob& request) {
  SpecOfAKind out;
  EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(request.work.spec, &out).ok());
  return out;
}

/// Expects that the worker receives exactly this spec, except for the number of threads, which the
/// worker pool chooses.
template <class SpecOfAKind>
void expect_given(const NewJob& request, SpecOfAKind wanted) {
  wanted.clear_threads();
  EXPECT_EQ(given<SpecOfAKind>(request).ShortDebugString(), wanted.ShortDebugString());
}

TEST(Spec, EveryFieldReachesTheWorker) {
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
  const auto request = check_job(job);
  ASSERT_TRUE(request) << request.error().message;
  expect_given(*request, spec);
  EXPECT_EQ(request->threads, 4);
  EXPECT_EQ(request->work.inputs.size(), 5U);
  EXPECT_EQ(request->display_name, "simulate spot.obj");
}

TEST(Spec, UnsetFieldsKeepTheWorkersDefaults) {
  const auto request = check_job(job_with_mesh());
  ASSERT_TRUE(request);
  expect_given(*request, job_with_mesh().simulate());
}

template <class SpecOfAVerb>
void expect_inertia_for_the_sheet_alone(v1::Job& job, SpecOfAVerb& spec, const std::string& field) {
  const auto has_inertia = [&] {
    const auto request = check_job(job);
    EXPECT_TRUE(request) << request.error().message;
    return request && given<SpecOfAVerb>(*request).inertia();
  };
  EXPECT_FALSE(has_inertia());
  spec.set_inertia(true);
  EXPECT_TRUE(has_inertia()) << "the default model is the sheet, which may have inertia";
  spec.set_model(v1::MODEL_SHEET);
  EXPECT_TRUE(has_inertia());
  spec.set_model(v1::MODEL_STOKES);
  EXPECT_EQ(refused_field(job), field);
  spec.set_inertia(false);
  EXPECT_FALSE(has_inertia());
}

TEST(Spec, InertiaRequiresTheSheetModel) {
  v1::Job simulate = job_with_mesh();
  expect_inertia_for_the_sheet_alone(simulate, *simulate.mutable_simulate(), "simulate.inertia");
  v1::Job predict;
  set_file(*predict.mutable_predict()->mutable_mesh(), "spot.obj");
  set_file(*predict.mutable_predict()->mutable_film_image(), "film.png");
  expect_inertia_for_the_sheet_alone(predict, *predict.mutable_predict(), "predict.inertia");
}

v1::Job plan_of_two_dips() {
  v1::Job job;
  v1::PlanSpec& spec = *job.mutable_plan();
  set_file(*spec.mutable_object()->mutable_mesh(), "spot.obj");
  for (int k = 0; k < 2; ++k) {
    v1::Pose& pose = *spec.add_immersions()->mutable_pose();
    for (int i = 0; i < 4; ++i) pose.add_rotation_wxyz(i == k ? 1 : 0);
    for (int i = 0; i < 3; ++i) pose.add_translation_mm(0);
  }
  return job;
}

TEST(Spec, PlanWithItsNestedFilesReachesTheWorker) {
  v1::Job job = plan_of_two_dips();
  v1::PlanSpec& spec = *job.mutable_plan();
  set_file(*spec.mutable_object()->mutable_texture(), "spot.png");
  set_file(*spec.mutable_object()->add_extra_files(), "film.json");
  set_file(*spec.mutable_film()->mutable_profile(), "p.toml");
  spec.mutable_film()->set_film("polygon:film.json");
  spec.mutable_immersions(1)->set_depth_mm(20);
  spec.set_blend_mm(3);
  spec.set_threads(2);
  const auto request = check_job(job);
  ASSERT_TRUE(request) << request.error().message;
  expect_given(*request, spec);
  EXPECT_EQ(request->threads, 2);
  EXPECT_EQ(request->work.verb, "plan");
  EXPECT_EQ(request->display_name, "plan spot.obj");
  std::vector<std::string> names;
  for (const InputFile& file : request->work.inputs) names.push_back(file.name);
  EXPECT_EQ(names, (std::vector<std::string>{"spot.obj", "spot.png", "film.json", "p.toml"}));
}

TEST(Spec, WrongFieldsOfAPlanAreNamedWithTheirMessages) {
  const auto refused = [](const std::function<void(v1::PlanSpec&)>& spoil) {
    v1::Job job = plan_of_two_dips();
    spoil(*job.mutable_plan());
    return refused_field(job);
  };
  EXPECT_EQ(refused([](auto&) {}), "accepted");
  EXPECT_EQ(refused([](auto& s) { s.clear_immersions(); }), "plan.immersions");
  EXPECT_EQ(refused([](auto& s) {
              while (s.immersions_size() < 13) *s.add_immersions() = s.immersions(0);
            }),
            "plan.immersions");
  EXPECT_EQ(refused([](auto& s) { s.clear_object(); }), "plan.object");
  EXPECT_EQ(refused([](auto& s) { s.mutable_object()->clear_mesh(); }), "plan.object.mesh");
  EXPECT_EQ(refused([](auto& s) { s.mutable_object()->set_scale(0); }), "plan.object.scale");
  EXPECT_EQ(refused([](auto& s) { s.mutable_immersions(1)->set_depth_mm(-1); }),
            "plan.immersions[1].depth_mm");
  EXPECT_EQ(
      refused([](auto& s) { s.mutable_immersions(1)->mutable_pose()->set_rotation_wxyz(0, 2); }),
      "plan.immersions[1].pose.rotation_wxyz");
  EXPECT_EQ(refused([](auto& s) { s.mutable_film()->set_film("A9"); }), "plan.film.film");
  EXPECT_EQ(refused([](auto& s) { s.mutable_film()->set_film("polygon:film.json"); }),
            "plan.film.film");
  EXPECT_EQ(refused([](auto& s) {
              s.mutable_film()->set_model(v1::MODEL_STOKES);
              s.mutable_film()->set_inertia(true);
            }),
            "plan.film.inertia");
  EXPECT_EQ(refused([](auto& s) { s.set_blend_mm(0); }), "plan.blend_mm");
  EXPECT_EQ(refused([](auto& s) { set_file(*s.mutable_film()->mutable_profile(), "spot.obj"); }),
            "NAME_INVALID");
}

TEST(Spec, WrongFilesAreNamedWithTheirPlaceInThePlan) {
  v1::Job job = plan_of_two_dips();
  v1::ObjectSetup& object = *job.mutable_plan()->mutable_object();
  set_file(*object.add_extra_files(), "spot.mtl");
  set_file(*object.add_extra_files(), "/spot.png");
  EXPECT_EQ(refused_field(job), "plan.object.extra_files.name");
  object.mutable_mesh()->set_name("../spot.obj");
  EXPECT_EQ(refused_field(job), "plan.object.mesh.name");
  job = plan_of_two_dips();
  job.mutable_plan()->mutable_film()->mutable_profile()->set_name("p.toml");
  const auto request = check_job(job);
  ASSERT_FALSE(request);
  EXPECT_EQ(request.error().reason, ErrorReason::ID_INVALID);
  EXPECT_TRUE(request.error().message.starts_with("plan.film.profile.asset: "))
      << request.error().message;
}

TEST(Spec, PaintsAreCheckedWhereverTheyAre) {
  v1::Job job;
  v1::SimulateSpec& spec = *job.mutable_simulate();
  set_file(*spec.mutable_mesh(), "cat.stl");
  v1::PaintLayer& layer = *spec.mutable_paint()->add_layers();
  EXPECT_EQ(refused_field(job), "simulate.paint.layers[0].picture");
  set_file(*layer.mutable_picture(), "fur.png");
  EXPECT_EQ(refused_field(job), "accepted");
  // The same picture in two layers is one file.
  *spec.mutable_paint()->add_layers() = layer;
  EXPECT_EQ(refused_field(job), "accepted");
  layer.set_projection("planar");
  for (int i = 0; i < 3; ++i) layer.add_direction(0);
  EXPECT_EQ(refused_field(job), "simulate.paint.layers[0].direction");
  layer.set_direction(1, 2);
  layer.set_colour("blue");
  EXPECT_EQ(refused_field(job), "simulate.paint.layers[0].colour");
  layer.clear_colour();
  set_file(*spec.mutable_texture(), "fur.png");
  EXPECT_EQ(refused_field(job), "simulate.texture");
  spec.clear_paint();
  spec.set_project("decal");
  EXPECT_EQ(refused_field(job), "accepted");
  spec.clear_texture();
  EXPECT_EQ(refused_field(job), "simulate.project");

  job = plan_of_two_dips();
  v1::PaintLayer& of_plan = *job.mutable_plan()->mutable_object()->mutable_paint()->add_layers();
  set_file(*of_plan.mutable_picture(), "fur.png");
  of_plan.set_size_mm(-1);
  EXPECT_EQ(refused_field(job), "plan.object.paint.layers[0].size_mm");
}

TEST(Spec, PredictRequiresItsOwnFiles) {
  v1::Job job;
  set_file(*job.mutable_predict()->mutable_mesh(), "spot.obj");
  EXPECT_EQ(refused_field(job), "predict.film_image");
  set_file(*job.mutable_predict()->mutable_film_image(), "film.png");
  set_file(*job.mutable_predict()->mutable_motion(), "path.csv");
  const auto request = check_job(job);
  ASSERT_TRUE(request);
  EXPECT_EQ(request->work.verb, "predict");
  expect_given(*request, job.predict());
}

TEST(Spec, FitHasPointsAndFreeParameters) {
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
  const auto request = check_job(job);
  ASSERT_TRUE(request) << request.error().message;
  EXPECT_EQ(request->work.verb, "fit");
  expect_given(*request, spec);
  EXPECT_EQ(request->work.inputs.size(), 3U);
  EXPECT_EQ(request->threads, 2);
  EXPECT_EQ(request->display_name, "fit ball.ply");

  for (const char* bad : {"", "a,b", "--out=x", "Drag", "ink-ratio", "density"}) {
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
  auto request = check_job(job);
  ASSERT_TRUE(request) << request.error().message;
  EXPECT_EQ(request->work.verb, "validate");
  expect_given(*request, spec);
  EXPECT_TRUE(request->work.inputs.empty());
  EXPECT_EQ(request->display_name, "validate");

  spec.add_only("accuracy");
  spec.add_only("bowl");
  spec.set_quick(true);
  spec.set_threads(3);
  request = check_job(job);
  ASSERT_TRUE(request) << request.error().message;
  expect_given(*request, spec);
  EXPECT_EQ(request->threads, 3);

  for (const char* bad : {"", "a,b", "--out=x", "Accuracy", "a b", "cat-bowl"}) {
    spec.set_only(0, bad);
    EXPECT_EQ(refused_field(job), "validate.only") << bad;
  }
  spec.set_only(0, "accuracy");
  for (int i = 0; i < 40; ++i) spec.add_only("models");
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

TEST(Spec, EveryFieldOfPrintImageReachesTheWorker) {
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
  const auto request = check_job(job);
  ASSERT_TRUE(request) << request.error().message;
  EXPECT_EQ(request->work.verb, "print-image");
  expect_given(*request, spec);
  EXPECT_EQ(request->threads, 2);
  EXPECT_EQ(request->work.inputs.size(), 3U);
  EXPECT_EQ(request->display_name, "print-image film.png");
}

TEST(Spec, PrintImageRefusesImpossiblePages) {
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
  EXPECT_EQ(refused([](auto& spec) { spec.add_formats("svg"); }), "print_image.formats");
  EXPECT_EQ(refused([](auto& spec) { spec.set_job_name("a\nb"); }), "print_image.job_name");
  EXPECT_EQ(refused([](auto& spec) { spec.set_date(std::string(201, '1')); }), "print_image.date");
  for (const char* bad : {"A4\n--out=/", "A9", "circle:50", "9x200", "210x2001", "19x100"}) {
    EXPECT_EQ(refused([&](auto& spec) { spec.set_paper(bad); }), "print_image.paper") << bad;
  }
  EXPECT_EQ(refused([](auto& spec) { spec.set_printer_margin_mm(95); }), "accepted");
  EXPECT_EQ(refused([](auto& spec) { spec.set_printer_margin_mm(95.5); }),
            "print_image.printer_margin_mm")
      << "twice this margin leaves less than 20 mm of the 210 mm of A4";
}

TEST(Spec, TemplateHasObjectFilmAndPaper) {
  v1::Job job;
  auto& spec = *job.mutable_template_();
  spec.set_scale(10);
  EXPECT_EQ(refused_field(job), "template.mesh");
  set_file(*spec.mutable_mesh(), "mug.obj");
  spec.set_film("A3");
  spec.set_paper("A3");
  spec.set_date("today");
  const auto request = check_job(job);
  ASSERT_TRUE(request) << request.error().message;
  EXPECT_EQ(request->work.verb, "template");
  expect_given(*request, spec);
  EXPECT_EQ(request->display_name, "template mug.obj");
}

TEST(Spec, ResolutionMatchesTheWorkersRange) {
  for (const double dpi : {20.0, 2400.0, 19.9, 2400.1}) {
    v1::Job job = job_with_mesh();
    job.mutable_simulate()->set_dpi(dpi);
    EXPECT_EQ(check_job(job).has_value(), dpi >= 20 && dpi <= 2400) << dpi;
  }
}

TEST(Spec, InvalidNumbersAreRefused) {
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

TEST(Spec, FilmsAreParsedAsInTheWorker) {
  v1::Job job = job_with_mesh();
  v1::SimulateSpec& spec = *job.mutable_simulate();
  set_file(*spec.add_extra_files(), "film.json");
  for (const char* good : {"A4", "a3", "letter", "100x120.5", "circle:50", "polygon:film.json"}) {
    spec.set_film(good);
    EXPECT_EQ(refused_field(job), "accepted") << good;
  }
  for (const char* bad : {"A9", "", "100", "100x", "5x100", "100x2001", "circle:", "circle:4.9",
                          "circle:-50", "nanxnan", "polygon:other.json", "polygon:"}) {
    spec.set_film(bad);
    EXPECT_EQ(refused_field(job), "simulate.film") << bad;
  }
}

TEST(Spec, AllWrongFieldsAreReportedTogether) {
  v1::Job job = job_with_mesh();
  job.set_priority(-1);
  job.mutable_simulate()->set_film("A9");
  job.mutable_simulate()->set_dpi(1);
  const auto request = check_job(job);
  ASSERT_FALSE(request);
  EXPECT_EQ(request.error().reason, ErrorReason::SPEC_INVALID);
  EXPECT_EQ(request.error().field, "priority");
  const auto violations = rest::violations_of(request.error());
  ASSERT_EQ(violations.size(), 3U);
  EXPECT_EQ(violations[1].field, "simulate.film");
  EXPECT_EQ(violations[2].field, "simulate.dpi");
  EXPECT_EQ(violations[2].problem, "must be from 20 to 2400 dots per inch");
}

TEST(Spec, InvalidPosesAreRefused) {
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

TEST(Spec, EveryFieldOfCalibrateReachesTheWorker) {
  v1::Job job = calibrate_job();
  job.mutable_calibrate()->set_gripper_mm(-2.5);
  set_file(*job.mutable_calibrate()->mutable_camera(), "camera.json");
  const auto request = check_job(job);
  ASSERT_TRUE(request) << request.error().message;
  EXPECT_FALSE(request->use_cache);
  EXPECT_EQ(request->work.inputs.size(), 5U);
  expect_given(*request, job.calibrate());
  job = calibrate_job();
  set_file(*job.mutable_calibrate()->add_frames(), "other/frames.json");
  EXPECT_EQ(refused_field(job), "calibrate.frames")
      << "calibrate takes the frames of only one view";
  job.mutable_calibrate()->clear_frames();
  EXPECT_EQ(refused_field(job), "calibrate.frames");
  job = calibrate_job();
  job.mutable_calibrate()->clear_layout();
  EXPECT_EQ(refused_field(job), "calibrate.layout");
  job = calibrate_job();
  job.mutable_calibrate()->set_gripper_mm(std::nan(""));
  EXPECT_EQ(refused_field(job), "calibrate.gripper_mm");
}

TEST(Spec, EachBoardViewIsAFolder) {
  v1::Job job;
  for (const char* name : {"a/frames.json", "a/1.png", "b/c/frames.json"})
    set_file(*job.mutable_calibrate_camera()->add_frames(), name);
  expect_given(*check_job(job), job.calibrate_camera());
  EXPECT_EQ(check_job(job)->work.verb, "calibrate-camera");
  EXPECT_EQ(check_job(job)->display_name, "calibrate-camera of 2 views");
  set_file(*job.mutable_calibrate_camera()->add_frames(), "a/1.png");
  EXPECT_EQ(refused_field(job), "NAME_INVALID");
}

TEST(Spec, CaptureDurationIsLimited) {
  v1::Job job;
  job.mutable_capture()->set_seconds(20);
  EXPECT_EQ(refused_field(job), "accepted");
  for (const double wrong : {0.0, 20.1, std::nan("")}) {
    job.mutable_capture()->set_seconds(wrong);
    EXPECT_EQ(refused_field(job), "capture.seconds");
  }
}

std::string refused_dip(const v1::DipSpec& spec) {
  v1::Job job;
  *job.mutable_dip() = spec;
  return refused_field(job);
}

TEST(DipSpec, EveryNumberHasItsRange) {
  v1::DipSpec good;
  good.set_depth_mm(20);
  EXPECT_EQ(refused_dip(good), "accepted");
  EXPECT_EQ(refused_dip({}), "dip.depth_mm");
  using Set = void (v1::DipSpec::*)(double);
  struct Case {
    const char* field;
    Set set;
    double bad;
  };
  const Case cases[] = {{"depth_mm", &v1::DipSpec::set_depth_mm, 0},
                        {"depth_mm", &v1::DipSpec::set_depth_mm, INFINITY},
                        {"speed_mm_per_s", &v1::DipSpec::set_speed_mm_per_s, 0},
                        {"speed_mm_per_s", &v1::DipSpec::set_speed_mm_per_s, NAN},
                        {"hold_s", &v1::DipSpec::set_hold_s, -0.1},
                        {"hold_s", &v1::DipSpec::set_hold_s, 601},
                        {"retract_speed_mm_per_s", &v1::DipSpec::set_retract_speed_mm_per_s, -1},
                        {"clearance_mm", &v1::DipSpec::set_clearance_mm, 0.9},
                        {"clearance_mm", &v1::DipSpec::set_clearance_mm, 201},
                        {"film_area_mm2", &v1::DipSpec::set_film_area_mm2, 0},
                        {"activator_ml_per_m2", &v1::DipSpec::set_activator_ml_per_m2, 1001},
                        {"soak_s", &v1::DipSpec::set_soak_s, 3601},
                        {"activator_wait_s", &v1::DipSpec::set_activator_wait_s, -1},
                        {"activation_window_s", &v1::DipSpec::set_activation_window_s, 0.5},
                        {"water_temperature_c", &v1::DipSpec::set_water_temperature_c, 101}};
  for (const Case& each : cases) {
    v1::DipSpec spec = good;
    (spec.*each.set)(each.bad);
    EXPECT_EQ(refused_dip(spec), std::string("dip.") + each.field) << each.bad;
  }
  v1::DipSpec named = good;
  named.set_simulate_job("job 7");
  EXPECT_EQ(refused_dip(named), "ID_INVALID");
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
  EXPECT_EQ(refused_field(job), "NAME_INVALID") << "two files have the same name";
  job = job_with_mesh();
  set_file(*job.mutable_simulate()->mutable_texture(), "spot.obj/a.png");
  EXPECT_EQ(refused_field(job), "NAME_INVALID") << "the name uses the file spot.obj as a folder";
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

TEST(Digest, DependsOnlyOnInputsOfTheResult) {
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

TEST(Digest, DependsOnFilesInNestedMessages) {
  v1::Job job = plan_of_two_dips();
  const std::string digest = input_digest(check_job(job)->work, "w");
  job.mutable_plan()->set_threads(3);
  EXPECT_EQ(input_digest(check_job(job)->work, "w"), digest);
  job.mutable_plan()->mutable_object()->mutable_mesh()->set_asset("assets/" + std::string(64, 'b'));
  EXPECT_NE(input_digest(check_job(job)->work, "w"), digest);
}

}  // namespace
}  // namespace hydroprint::daemon
