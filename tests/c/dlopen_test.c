/* SPDX-License-Identifier: MIT */
/* The library of C is opened while the program runs. Argument: its path. */
#include <cairn/cairn.h>
#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

/* What POSIX promises, and ISO C does not: functions as void*. */
#define FIND(name)                                         \
  do {                                                     \
    void* found = dlsym(library, #name);                   \
    if (found == NULL) return printf("no %s\n", #name), 1; \
    memcpy(&name##_, &found, sizeof found);                \
  } while (0)

int main(int argc, char** argv) {
  void* library = argc == 2 ? dlopen(argv[1], RTLD_NOW | RTLD_LOCAL) : NULL;
  if (library == NULL) return printf("%s\n", argc == 2 ? dlerror() : "no path"), 1;
  CairnSettings (*cairnDefaultSettings_)(void);
  CairnBody (*cairnDefaultBody_)(void);
  CairnProblem (*cairnDefaultProblem_)(void);
  CairnStatus (*cairnCreateSolver_)(CairnLayout, const CairnSettings*, CairnSolver**);
  CairnStatus (*cairnSolve_)(CairnSolver*, const CairnProblem*, const CairnSolution*, CairnReport*);
  void (*cairnDestroySolver_)(CairnSolver*);
  FIND(cairnDefaultSettings);
  FIND(cairnDefaultBody);
  FIND(cairnDefaultProblem);
  FIND(cairnCreateSolver);
  FIND(cairnSolve);
  FIND(cairnDestroySolver);

  const CairnSettings settings = cairnDefaultSettings_();
  CairnSolver* solver = NULL;
  if (cairnCreateSolver_(cairnLayout(), &settings, &solver) != cairnOk) return 1;
  CairnBody body = cairnDefaultBody_();
  body.invMass = 2;
  body.impulse[1] = 3;
  CairnProblem problem = cairnDefaultProblem_();
  problem.bodies = &body;
  problem.bodyCount = 1;
  CairnVelocity velocity;
  const CairnSolution solution = {NULL, NULL, NULL, &velocity};
  if (cairnSolve_(solver, &problem, &solution, NULL) != cairnOk) return 1;
  cairnDestroySolver_(solver);
  dlclose(library);
  printf("velocity %.1f m/s\n", velocity.linear[1]);
  return velocity.linear[1] == 6 ? 0 : 1;
}
