const key = 'threepoint.preview';

/** Stores a study's plan in this tab for the preview page. */
export const storePreviewPlan = (plan: unknown): void => sessionStorage.setItem(key, JSON.stringify(plan));

/** Returns the stored plan as JSON, or null if there is none. */
export const loadPreviewPlan = (): string | null => sessionStorage.getItem(key);
