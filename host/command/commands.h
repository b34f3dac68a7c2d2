/* commands.h - the commands of the program. SPDX-License-Identifier: MIT */
#ifndef COMMANDS_H
#define COMMANDS_H

/* Each command takes the arguments behind its name, prints its messages and returns the exit status. */
int command_pair(int argc, char **argv);
int command_factors(int argc, char **argv);
int command_conductivity(int argc, char **argv);
int command_reproduce(int argc, char **argv);
int command_furnace(int argc, char **argv);
int command_heat(int argc, char **argv);
int command_couple(int argc, char **argv);
int command_join(int argc, char **argv);

#endif
