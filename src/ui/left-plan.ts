const key = 'threepoint.preview';

/** Leaves a study's plan in this tab for the page that previews it. */
export const leavePlan = (plan: unknown): void => sessionStorage.setItem(key, JSON.stringify(plan));

/** The plan that was left, as JSON; null: none was. */
export const leftPlan = (): string | null => sessionStorage.getItem(key);
