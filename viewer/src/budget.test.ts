import { describe, expect, test } from 'vitest';

import { Budget } from './budget';

function run(budget: Budget, milliseconds: number, frames: number, limited = true): void {
  for (let i = 0; i < frames; ++i) budget.frame(milliseconds, limited);
}

describe('the budget of points', () => {
  test('starts low', () => {
    expect(new Budget().points).toBe(300_000);
  });

  test('falls while frames are slow, down to a bound', () => {
    const budget = new Budget();
    run(budget, 60, 9);
    expect(budget.points).toBeLessThan(300_000);
    run(budget, 200, 500);
    expect(budget.points).toBe(Budget.lowest);
  });

  test('grows while frames are quick and there is more to draw, up to a bound', () => {
    const budget = new Budget();
    run(budget, 16, 9);
    expect(budget.points).toBeGreaterThan(300_000);
    run(budget, 16, 1000);
    expect(budget.points).toBe(Budget.highest);
  });

  test('does not grow when all is drawn', () => {
    const budget = new Budget();
    run(budget, 16, 100, false);
    expect(budget.points).toBe(300_000);
  });

  test('rests between slow and quick', () => {
    const budget = new Budget();
    run(budget, 1000 / 35, 200);
    expect(budget.points).toBe(300_000);
    expect(budget.fps).toBeCloseTo(35, 6);
    expect(budget.mayGrow).toBe(false);
  });

  test('does not mind a single late frame', () => {
    const budget = new Budget();
    for (let i = 0; i < 50; ++i) budget.frame(i % 7 === 3 ? 400 : 25, true);
    expect(budget.points).toBe(300_000);
  });

  test('is larger for a picture that rests, and that tells nothing of speed', () => {
    const budget = new Budget();
    budget.rest();
    expect(budget.points).toBe(1_200_000);
    run(budget, 500, 100);
    expect(budget.mayGrow).toBe(false);
    budget.wake();
    expect(budget.points).toBe(300_000);
    budget.fix(500_000);
    budget.rest();
    expect(budget.points).toBe(500_000);
  });

  test('stays where the user has put it, within bounds', () => {
    const budget = new Budget();
    budget.fix(2_000_000);
    run(budget, 500, 100);
    expect(budget.points).toBe(2_000_000);
    budget.fix(1);
    expect(budget.points).toBe(Budget.lowest);
    budget.fix(null);
    expect(budget.points).toBe(300_000);
  });
});
