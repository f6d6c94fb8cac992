#include "sim/worker/registry.h"

#include "sim/worker/verbs/calibrate.h"
#include "sim/worker/verbs/calibrate_camera.h"
#include "sim/worker/verbs/fit.h"
#include "sim/worker/verbs/fuse.h"
#include "sim/worker/verbs/predict.h"
#include "sim/worker/verbs/preview.h"
#include "sim/worker/verbs/print_image.h"
#include "sim/worker/verbs/simulate.h"
#include "sim/worker/verbs/template.h"
#include "sim/worker/verbs/validate.h"

namespace hydroprint::worker {

std::vector<Verb> verbs() {
  return {simulate_verb(),         predict_verb(),     preview_verb(),  fit_verb(),
          validate_verb(),         print_image_verb(), template_verb(), calibrate_verb(),
          calibrate_camera_verb(), fuse_verb()};
}

}  // namespace hydroprint::worker
