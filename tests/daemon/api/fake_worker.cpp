// A worker that follows commands in the mesh file instead of simulating; one command per line.
//
//   sleep SECONDS   waits and reports progress; ends on SIGTERM
//   stubborn        like sleep 60, but ignores SIGTERM
//   exit N WORDS    exits with status N and a Failure whose message is WORDS
//   reason WORD     the reason of the Failure
//   field WORD      the field of the Failure
//   crash           aborts
//   eat             allocates 64 GiB of memory, 16 MiB at a time
//   huge            writes a file of 64 MiB
//   fill            writes a small report, and then a file until the disk is full
//   many            writes 900 empty files with long names
//   nothing         writes no artifacts
//   link            writes a symbolic link as artifact
//   pipe            writes a named pipe as artifact
//   twice           writes an artifact with two names
//   elsewhere DIR   leaves a link to DIR in place of its output
//   deep N          writes N folders, one in the other
//   sparse N GIB    writes N sparse files of this size
//   garbage         writes a malformed calibration
//   report WHAT     writes a report that is "garbage", "missing" or "large", or has a "type",
//                   an "enum" value or a "nan" that is not allowed
//   babble          writes nonsense as progress
//   fork            reports whether it could start a process
//   socket          reports whether it could open a socket
//   kill-parent     reports whether it could kill the daemon
//   hurry           reports whether it could raise its priority
//   warn WORDS      adds this warning to the report
//   read FILE       reports whether it could read the file
//   write FILE      reports whether it could write the file
//
// After the commands it writes film.png, and report.json, whose program is the command line, whose
// version is what the commands reported, and whose only input is the spec. print-image writes
// print.pdf, which contains its film image, and spec.json. calibrate and calibrate-camera write a
// calibration and spec.json.

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <new>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace {

std::map<std::string, std::string> flags;
nlohmann::json spec;
nlohmann::json failure = nlohmann::json::object();
std::string facts;
std::string warning;
std::string fault;  // of the report
bool is_garbage = false;

/// Name of a file from the spec; empty if there is none.
std::string file_of(const std::string& field) {
  const auto& object = spec.contains("object") ? spec["object"] : spec;
  return object.contains(field) ? object[field].value("name", "") : "";
}

void write_line(const std::string& line) {
  if (flags.contains("--progress-file")) {
    std::ofstream(flags["--progress-file"], std::ios::app) << line << std::flush;
    return;
  }
  const int fd = std::stoi(flags["--progress-fd"]);
  if (write(fd, line.data(), line.size()) < 0) std::cerr << "the progress pipe is closed\n";
}

/// Waits until the daemon has read all progress.
void wait_until_read() {
  for (int unread_bytes = 1; unread_bytes > 0; usleep(1000)) {
    if (ioctl(std::stoi(flags["--progress-fd"]), FIONREAD, &unread_bytes) != 0) std::abort();
  }
}

void sleep_for(double seconds) {
  constexpr int kSteps_per_s = 20;
  const int steps = static_cast<int>(seconds * kSteps_per_s);
  for (int i = 0; i < steps; ++i) {
    const double done = static_cast<double>(i) / steps;
    std::ostringstream line;
    line << R"({"stage":"velocity","fraction":)" << done << R"(,"total_fraction":)" << done
         << R"(,"eta_s":)" << seconds * (1 - done) << "}\n";
    write_line(line.str());
    usleep(1000000 / kSteps_per_s);
  }
}

void eat() {
  constexpr std::size_t kBlock = 16 << 20;
  std::vector<char*> blocks;
  for (int i = 0; i < 4096; ++i) {
    blocks.push_back(new (std::nothrow) char[kBlock]);
    if (blocks.back() == nullptr) {  // ends as hydroprint-worker does
      std::cout << R"({"error":{"reason":"MEMORY_LIMIT"}})" << std::endl;
      std::_Exit(4);
    }
    std::memset(blocks.back(), i, kBlock);
    usleep(1000);
  }
}

void write_deep_folder(int depth) {
  std::filesystem::current_path(flags["--out"]);
  for (int i = 0; i < depth; ++i) {
    if (mkdir("d", 0700) != 0 || chdir("d") != 0) std::abort();
  }
}

void write_sparse_files(int count, off_t gib) {
  for (int i = 0; i < count; ++i) {
    const std::string file = flags["--out"] + "/sparse-" + std::to_string(i);
    const int fd = open(file.c_str(), O_WRONLY | O_CREAT, 0600);
    if (ftruncate(fd, gib << 30) != 0) std::abort();
    close(fd);
  }
}

void execute(const std::string& line) {
  std::istringstream words(line);
  std::string command, rest;
  words >> command;
  if (command == "sleep") {
    double seconds = 0;
    words >> seconds;
    sleep_for(seconds);
  } else if (command == "stubborn") {
    signal(SIGTERM, SIG_IGN);
    sleep_for(60);
  } else if (command == "exit") {
    int status = 0;
    words >> status;
    std::getline(words >> std::ws, rest);
    std::cerr << "for people: " << rest << std::endl;
    if (!rest.empty()) failure["message"] = rest;
    std::cout << nlohmann::json{{"error", failure}} << std::endl;
    std::_Exit(status);
  } else if (command == "warn") {
    std::getline(words >> std::ws, warning);
  } else if (command == "report") {
    words >> fault;
  } else if (command == "crash") {
    std::abort();
  } else if (command == "eat") {
    try {
      eat();
    } catch (const std::bad_alloc&) {
      std::cout << R"({"error":{"reason":"MEMORY_LIMIT"}})" << std::endl;
      std::_Exit(4);
    }
  } else if (command == "huge") {
    std::ofstream(flags["--out"] + "/huge") << std::string(64 << 20, 'x') << std::flush;
  } else if (command == "fill") {
    std::ofstream(flags["--out"] + "/report.json") << "{}";
    fault = "missing";  // later there is no space for it
    std::ofstream file(flags["--out"] + "/fill");
    while (file << std::string(4096, 'x') << std::flush) {
    }
  } else if (command == "many") {
    for (int i = 0; i < 900; ++i) {
      std::ofstream(flags["--out"] + "/" + std::string(200, 'n') + std::to_string(i));
    }
  } else if (command == "socket") {
    facts += socket(AF_INET, SOCK_STREAM, 0) < 0 ? " no-inet" : " INET";
    facts += socket(AF_UNIX, SOCK_STREAM, 0) < 0 ? " no-unix" : " UNIX";
  } else if (command == "read") {
    words >> rest;
    facts += std::ifstream(rest).get() < 0 ? " cannot-read" : " READ";
  } else if (command == "write") {
    words >> rest;
    facts += std::ofstream(rest, std::ios::app).put('x').flush() ? " WROTE" : " cannot-write";
  } else if (command == "kill-parent") {
    facts += kill(getppid(), SIGKILL) < 0 ? " no-kill" : " KILL";
    facts += tgkill(getppid(), getppid(), SIGKILL) < 0 ? " no-tgkill" : " TGKILL";
    const rlimit none{};
    facts += prlimit(getppid(), RLIMIT_NOFILE, &none, nullptr) < 0 ? " no-prlimit" : " PRLIMIT";
  } else if (command == "hurry") {
    const sched_param least{1};
    facts += sched_setscheduler(0, SCHED_FIFO, &least) < 0 ? " no-fifo" : " FIFO";
    const int before = getpriority(PRIO_PROCESS, 0);
    (void)setpriority(PRIO_PROCESS, 0, before - 1);
    facts += getpriority(PRIO_PROCESS, 0) < before ? " NICE" : " no-nice";
    rlimit real_time{};
    getrlimit(RLIMIT_RTPRIO, &real_time);
    facts += real_time.rlim_max == 0 ? " no-rtprio" : " RTPRIO";
  } else if (command == "garbage") {
    is_garbage = true;
  } else if (command == "reason" || command == "field") {
    words >> rest;
    failure[command] = rest;
  } else if (command == "nothing") {
    std::filesystem::remove_all(flags["--out"]);
    std::_Exit(0);
  } else if (command == "link") {
    std::filesystem::create_symlink("/etc/passwd", flags["--out"] + "/passwd");
  } else if (command == "pipe") {
    if (mkfifo((flags["--out"] + "/pipe").c_str(), 0600) != 0) std::abort();
  } else if (command == "twice") {
    std::ofstream(flags["--out"] + "/one") << "x";
    std::filesystem::create_hard_link(flags["--out"] + "/one", flags["--out"] + "/two");
  } else if (command == "elsewhere") {
    words >> rest;
    std::filesystem::remove_all(flags["--out"]);
    std::filesystem::create_directory_symlink(rest, flags["--out"]);
  } else if (command == "deep") {
    int depth = 0;
    words >> depth;
    write_deep_folder(depth);
  } else if (command == "sparse") {
    int count = 0;
    off_t gib = 0;
    words >> count >> gib;
    write_sparse_files(count, gib);
  } else if (command == "fork") {
    const pid_t child = fork();
    if (child == 0) _exit(0);
    facts += child < 0 ? " no-fork" : " FORK";
  } else if (command == "babble") {
    write_line(std::string(100000, '[') + "\n{\"stage\":7}\n\x01\x02\n");
    write_line(R"({"stage":"last\n\u0007word","total_fraction":7e99,"fraction":-1,"eta_s":1e300})"
               "\n");
    wait_until_read();
  }
}

/// Writes report.json with the fault that a command asked for.
void write_report(const nlohmann::json& report) {
  if (fault == "missing") return;
  nlohmann::json faulty = report;
  if (fault == "type") faulty["run"]["threads"] = "many";
  if (fault == "enum") faulty["run"]["warnings"] = {{{"code", "MADE_UP"}}};
  if (fault == "nan") faulty["run"]["total_seconds"] = "NaN";
  if (fault == "large") faulty["run"]["version"] = std::string(10 << 20, 'x');
  std::ofstream(flags["--out"] + "/report.json") << (fault == "garbage" ? "{" : faulty.dump());
}

void calibrate(bool is_camera) {
  const std::string out = flags["--out"];
  std::ofstream(out + "/spec.json") << spec;
  std::ofstream(out + "/camera.json") << "{}";
  std::ofstream(out + "/alignment.png") << "picture of " << file_of("mesh");
  if (is_camera) return write_report({{"views", 12}, {"rms_mm", 0.7}});
  nlohmann::json calibration = nlohmann::json::parse(
      R"({"pose":{"rotation_wxyz":[1,0,0,0],"translation_mm":[3,-2,40]},"uncertainty":{)"
      R"("about_mm":[0,0,40],"error_p50_mm":0.2,"error_p95_mm":0.4,"error_max_mm":0.5},)"
      R"("from_nominal_pose":["turn"],"symmetries":["any turn"],"film_frame":{"markers":[)"
      R"({"name":"left","used":true,"rms_mm":0.3,"residual_mm":0.1},)"
      R"({"name":"near","used":false,"why_not":"hidden"}]},)"
      R"("water":{"z_mm":0.25,"sigma_mm":0.1},"height_mm":10.5})");
  for (int i = 0; i < 36; ++i)
    calibration["uncertainty"]["covariance_turn_rad_shift_mm"].push_back(i % 6 == 0 ? 1 : 0);
  if (is_garbage) calibration["pose"]["rotation_wxyz"] = {1, 1, 0, 0};
  write_report({{"calibration", calibration}});
}

void print_image() {
  const std::string out = flags["--out"];
  std::ofstream(out + "/print.pdf") << "%PDF of " << std::ifstream(file_of("filmImage")).rdbuf();
  std::ofstream(out + "/spec.json") << spec;
  write_report({{"page", {{"printer_margin_mm", 0}}}, {"sheets", {{{"size_mm", {297, 210}}}}}});
}

void answer(const std::string& head, const std::string& bytes) {
  std::cout << head << ",\"bytes\":" << bytes.size() << "}\n" << bytes << std::flush;
}

// Answers preview requests. Commands in the mesh: "mute" sends no answer, but creates the file
// `asked` beside the spec, "rubbish" sends a malformed answer, "end" exits.
void preview() {
  std::stringstream mesh;
  mesh << std::ifstream(file_of("mesh")).rdbuf();
  for (std::string line; std::getline(std::cin, line);) {
    if (mesh.str().find("mute") != std::string::npos) {
      std::ofstream(std::filesystem::path(flags["--spec"]).replace_filename("asked"));
      continue;
    }
    if (mesh.str().find("rubbish") != std::string::npos) std::cout << std::string(300000, '[');
    if (mesh.str().find("end") != std::string::npos) std::_Exit(4);
    if (line.find("\"read\":true") != std::string::npos) {
      const std::string head = line.substr(0, line.size() - 1);
      if (mesh.str().find("plain") != std::string::npos) {
        answer(head + R"(,"error":{"code":"NOT_FOUND","reason":"INPUT_REFUSED","message":"m.png"})",
               "");
      } else {
        answer(head +
                   R"(,"summary":{"format":"OBJ","shown_triangles":3,)"
                   R"("warnings":[{"code":"FAR_FROM_ORIGIN","message":"m","where":{"item":"w"}}]})",
               "glTF" + std::to_string(getpid()));
      }
      continue;
    }
    answer(line.substr(0, line.size() - 1) +
               R"(,"pose":{"rotation_wxyz":[1,0,0,0],"translation_mm":[0,0,0]},"coverage":0.5,)"
               R"("theta_clamped_share":null,"stretch":{"p50":1,"p95":2,"max":null},"seconds":0.1,)"
               R"("depth_mm":)" +
               std::to_string(getpid()) +
               R"(,"warnings":[{"code":"FILM_TORN","message":"m","where":{"item":"w"}}])",
           std::string(16, 'm'));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (std::string(argv[1]) == "--version") {  // a copy of another size is another build
    std::cout << R"({"build_id":")" << std::hex << std::filesystem::file_size("/proc/self/exe")
              << "\"}" << std::endl;
    return 0;
  }
  for (int i = 2; i < argc; ++i) {
    const std::string text = argv[i];
    flags[text.substr(0, text.find('='))] = text.substr(text.find('=') + 1);
  }
  if (flags.contains("--spec")) spec = nlohmann::json::parse(std::ifstream(flags["--spec"]));
  const bool is_preview = std::string(argv[1]) == "preview";
  if (!is_preview) std::filesystem::create_directory(flags["--out"]);
  std::ifstream mesh(file_of("mesh"));
  for (std::string line; std::getline(mesh, line);) execute(line);
  if (is_preview) {
    preview();
    return 0;
  }
  const std::string verb = argv[1];
  if (verb.starts_with("calibrate")) {
    calibrate(verb == "calibrate-camera");
    return 0;
  }
  if (verb == "print-image") {
    print_image();
    return 0;
  }
  std::ofstream(flags["--out"] + "/film.png") << "film of " << file_of("mesh");
  std::string line;
  for (int i = 1; i < argc; ++i) line += std::string(argv[i]) + ' ';
  nlohmann::json run = {{"program", line},
                        {"version", facts},
                        {"verb", verb},
                        {"inputs", {{{"role", "spec"}, {"path", spec.dump()}}}}};
  if (!warning.empty())
    run["warnings"] = {
        {{"code", "FILM_TORN"}, {"message", warning}, {"where", {{"surface", true}}}}};
  write_report({{"run", run}});
}
