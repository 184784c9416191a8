/* llvmpipe gives each of its threads one run of a dispatch's groups. What lies next to each other in a list
 * costs about as much: dealt to the runs in turn, a list keeps all threads at work to the end. Expects
 * RUNS: how many there are; 1 on devices that take groups as they come. */
uint dealt(uint group, uint count)
{
    uint each = count / RUNS, more = count % RUNS, longer = more * (each + 1u);
    uint run = group < longer ? group / (each + 1u) : more + (group - longer) / max(each, 1u);
    return (group - run * each - min(run, more)) * RUNS + run;
}
