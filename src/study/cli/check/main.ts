import { existsSync, readFileSync } from 'node:fs';
import { ValidationError } from 'threepoint/core';
import { ConfigurationError } from 'threepoint-http';
import { embodimentInWords } from '../../model/plan/embodiment';
import { claimOf } from '../../model/plan/hypotheses';
import { languagesOf, participantsOf, readPlan, type StudyPlan, studyTitle, taskTitle } from '../../model/plan/plan';
import { durationOf, outlineOf } from '../../model/plan/plan-outline';
import { cohortCounts, orderCounts, remarksOn } from '../../model/plan/plan-remarks';

const [file = '', participant] = process.argv.slice(2);

const clock = (seconds: number) => {
  const whole = Math.round(seconds);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')}`;
};

function summary(plan: StudyPlan): readonly string[] {
  const { played, rests, questionnaires } = durationOf(plan);
  const lines = [
    `"${studyTitle(plan)}" (${plan.id}): ${plan.participants} participants, in ${languagesOf(plan).join(', ')}, seed ${plan.seed}.`,
    `A participant takes at most ${clock(played + rests + questionnaires)} min: ${clock(played)} of play, ${clock(rests)} of rest, ` +
      `${clock(questionnaires)} of questionnaires. Consent, measures and demographics take additional time.`,
  ];
  for (const { id, label, ...body } of plan.conditions) {
    lines.push(`Condition "${id}", ${label}: ${embodimentInWords(body) || 'as its cohort'}.`);
  }
  const sizes = cohortCounts(plan);
  for (const { id, label, ...body } of plan.cohorts ?? []) {
    lines.push(`Cohort "${id}", ${label}, ${sizes.get(id)} participants: ${embodimentInWords(body)}.`);
  }
  for (const task of plan.tasks) {
    for (const cohort of plan.cohorts ?? [null]) {
      const counts = [...orderCounts(plan, task, cohort)].map(([order, count]) => `${order} ${count} times`);
      lines.push(`${taskTitle(plan, task.id)}${cohort ? `, cohort ${cohort.id}` : ''}: ${counts.join('; ')}.`);
    }
  }
  const { hypotheses = [], remote, askToStop = [] } = plan;
  for (const hypothesis of hypotheses) {
    lines.push(`Hypothesis ${hypothesis.id}: ${claimOf(hypothesis)} in ${hypothesis.measures.join(', ')}.`);
  }
  if (remote) {
    lines.push(
      `Participants take part alone (remote): device, ${remote.freeSpace} m of room and height are checked. They read: ${remote.contact}`,
    );
  }
  for (const { questionnaire, measure, atLeast } of askToStop) {
    lines.push(
      `Asked whether to stop (askToStop): participants with "${measure}" of "${questionnaire}" from ${atLeast} on.`,
    );
  }
  return [...lines, ...remarksOn(plan).map((remark) => `Before you begin: ${remark}`)];
}

function check(): void {
  if (!existsSync(file)) throw new ValidationError('', `there is no file ${file}`);
  const read = readPlan(readFileSync(file, 'utf8'), file);
  if ('problems' in read) {
    for (const { message } of read.problems) console.error(message);
    console.error(`${read.problems.length === 1 ? 'One mistake' : `${read.problems.length} mistakes`} in ${file}.`);
    process.exitCode = 1;
    return;
  }
  const { plan } = read;
  const shown = participant ?? (participantsOf(plan)[0] as string);
  const screens = outlineOf(plan, shown).map(
    ({ at, seconds, shows }) => `  ${at.padEnd(8)} ${(seconds === null ? '' : clock(seconds)).padStart(6)}  ${shows}`,
  );
  console.log([`${file}: the plan is valid.`, ...summary(plan), '', `What ${shown} sees:`, ...screens].join('\n'));
}

try {
  check();
} catch (error) {
  if (!(error instanceof ValidationError || error instanceof ConfigurationError)) throw error;
  console.error(error.message);
  process.exitCode = 1;
}
