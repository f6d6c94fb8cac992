// Runs a program as on a kernel with an older Landlock: old_kernel VERSION PROGRAM [ARGUMENT...]
//
// VERSION is what landlock_create_ruleset() answers to the question for its version; 0: the kernel has no Landlock. All other
// system calls are the kernel's own. The program keeps the process id of old_kernel.
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

enum { kVersionQuestion = 1 };  // LANDLOCK_CREATE_RULESET_VERSION

static int fail(const char* what) {
  fprintf(stderr, "old_kernel: %s: %s\n", what, strerror(errno));
  return 1;
}

// Lets the kernel or `answer` decide each call of landlock_create_ruleset(). Returns the descriptor that is asked, or 0.
static int install(int answer) {
  const unsigned action = answer > 0 ? SECCOMP_RET_USER_NOTIF : SECCOMP_RET_ERRNO | ENOSYS;
  struct sock_filter filter[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, arch)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, AUDIT_ARCH_X86_64, 0, 3),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_landlock_create_ruleset, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, action),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  struct sock_fprog program = {sizeof filter / sizeof filter[0], filter};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return -1;
  return (int)syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, answer > 0 ? SECCOMP_FILTER_FLAG_NEW_LISTENER : 0, &program);
}

// Answers until the last process with the filter has ended.
static void answer_questions(int listener, int version) {
  struct pollfd waits = {listener, POLLIN, 0};
  for (;;) {
    if (poll(&waits, 1, -1) < 0 && errno != EINTR) return;
    if (!(waits.revents & POLLIN)) {
      if (waits.revents & (POLLHUP | POLLERR | POLLNVAL)) return;
      continue;
    }
    struct seccomp_notif question;
    memset(&question, 0, sizeof question);
    if (ioctl(listener, SECCOMP_IOCTL_NOTIF_RECV, &question) != 0) continue;
    struct seccomp_notif_resp reply;
    memset(&reply, 0, sizeof reply);
    reply.id = question.id;
    if (question.data.args[2] == kVersionQuestion) {
      reply.val = version;
    } else {
      reply.flags = SECCOMP_USER_NOTIF_FLAG_CONTINUE;
    }
    ioctl(listener, SECCOMP_IOCTL_NOTIF_SEND, &reply);
  }
}

union Message {
  char bytes[CMSG_SPACE(sizeof(int))];
  struct cmsghdr aligned;
};

static int send_descriptor(int channel, int descriptor) {
  char byte = 0;
  struct iovec data = {&byte, 1};
  union Message control;
  memset(&control, 0, sizeof control);
  struct msghdr message = {.msg_iov = &data, .msg_iovlen = 1, .msg_control = &control, .msg_controllen = sizeof control};
  struct cmsghdr* header = CMSG_FIRSTHDR(&message);
  header->cmsg_level = SOL_SOCKET;
  header->cmsg_type = SCM_RIGHTS;
  header->cmsg_len = CMSG_LEN(sizeof descriptor);
  memcpy(CMSG_DATA(header), &descriptor, sizeof descriptor);
  return sendmsg(channel, &message, 0) == 1 ? 0 : -1;
}

static int receive_descriptor(int channel) {
  char byte;
  struct iovec data = {&byte, 1};
  union Message control;
  struct msghdr message = {.msg_iov = &data, .msg_iovlen = 1, .msg_control = &control, .msg_controllen = sizeof control};
  if (recvmsg(channel, &message, MSG_CMSG_CLOEXEC) != 1 || !CMSG_FIRSTHDR(&message)) return -1;
  int descriptor;
  memcpy(&descriptor, CMSG_DATA(CMSG_FIRSTHDR(&message)), sizeof descriptor);
  return descriptor;
}

// A process that is not a child of the program, and keeps none of its descriptors open.
static void start_answering(int channel, int version) {
  pid_t child = fork();
  if (child != 0) {
    waitpid(child, NULL, 0);
    return;
  }
  if (fork() != 0) _exit(0);
  setsid();
  int nothing = open("/dev/null", O_RDWR);
  for (int fd = 0; fd < 3; ++fd) dup2(nothing, fd);
  int listener = receive_descriptor(channel);
  close(channel);
  if (listener >= 0) answer_questions(listener, version);
  _exit(0);
}

int main(int count, char** arguments) {
  if (count < 3) {
    fprintf(stderr, "usage: old_kernel VERSION PROGRAM [ARGUMENT...]\n");
    return 2;
  }
  int version = atoi(arguments[1]), ends[2];
  if (version > 0) {
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return fail("socketpair");
    start_answering(ends[1], version);
    close(ends[1]);
  }
  int listener = install(version);
  if (listener < 0) return fail("seccomp");
  if (version > 0) {
    if (send_descriptor(ends[0], listener) != 0) return fail("sendmsg");
    close(listener);
    close(ends[0]);
  }
  execv(arguments[2], arguments + 2);
  return fail(arguments[2]);
}
